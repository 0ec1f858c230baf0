; expect 4:1 2 control points for a curve of order 3
G21 G90 G17
G00 X0. Y0. Z20.
G06.2 P3 K0 X0. Y0. F100.
K0 X5.
K1
K1
K1
