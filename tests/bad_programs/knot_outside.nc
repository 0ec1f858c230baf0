; expect 4:1 a knot outside of a surface or curve
G21 G90 G17
G00 X0. Y0. Z20.
K0
