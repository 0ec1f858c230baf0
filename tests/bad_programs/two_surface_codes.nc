; expect 4:8 G6.23 and G106.1 exclude each other
G21 G90 G17
G00 X0. Y0. Z20.
G06.23 G106.1 W20. U2 V2
X0. Y0. Z0. W1.
X10.
X0. Y10.
X10.
