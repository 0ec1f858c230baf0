; expect 4:14 P1: an order (an integer from 2 to 26)
G21 G90 G17
G00 X0. Y0. Z20.
G06.23 U2 V2 P1 Q2 D5. F500. S0.01
X0. Y0. Z0. W1.
X10.
X0. Y10.
X10.
