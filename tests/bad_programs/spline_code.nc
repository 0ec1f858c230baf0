; expect 4:1 G5.2 (spline) is not read
G21 G90 G17
G00 X0. Y0. Z20.
G05.2 P1 X1.
