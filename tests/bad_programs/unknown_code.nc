; expect 4:1 G6.24 is not known
G21 G90 G17
G00 X0. Y0. Z20.
G06.24 U2 V2
X0. Y0. Z0. W1.
X10.
X0. Y10.
X10.
