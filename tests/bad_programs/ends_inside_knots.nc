; expect 14:1 the program ends after 6 of 8 knots
G21 G90 G17
G00 X0. Y0. Z20.
G06.23 U2 V2 P2 Q2 D5. L0. F500. S0.01
X0. Y0. Z0. W1.
X10.
X0. Y10.
X10.
K0
K0
K1
K1
K0
K0
