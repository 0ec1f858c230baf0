; expect 4:1 all control points lie in one point
G21 G90 G17
G00 X0. Y0. Z20.
G06.23 U2 V2 P2 Q2 D5. L0. F500. S0.01
X1. Y1. Z1.
X1.
X1.
X1.
