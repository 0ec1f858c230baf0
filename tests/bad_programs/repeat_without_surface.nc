; expect 5:5 a move inside G106.1 before its surface
G21 G90 G17
G00 X0. Y0. Z20.
G106.1 W40.
G91 X10.
G80
