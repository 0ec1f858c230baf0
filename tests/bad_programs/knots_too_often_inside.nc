; expect 16:1 knot 4 of U, 1, stands there too often
G21 G90 G17
G00 X0. Y0. Z20.
G06.23 U4 V2 P2 Q2 D5. F500. S0.01
X0. Y0. Z0.
X3.
X6.
X9.
X0. Y9.
X3.
X6.
X9.
K0
K0
K1
K1
K2
K2
K0
K0
K1
K1
