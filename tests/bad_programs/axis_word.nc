; expect 4:10 the axis A
G21 G90 G17
G00 X0. Y0. Z20.
G00 X10. A45.
