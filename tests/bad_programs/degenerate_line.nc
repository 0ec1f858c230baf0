; expect 4:1 on one line
G21 G90 G17
G00 X0. Y0. Z20.
G06.23 U2 V2 P2 Q2 D5. L0. F500. S0.01
X0. Y0. Z0.
X1. Y1. Z2.
X2. Y2. Z4.
X3. Y3. Z6.
