; expect 4:14 N10 is not the number of a surface behind G106.2
G21 G90 G17
G00 X0. Y0. Z20.
G106.2 I1 E1 P10 Q20 W15. D5. M1. S0.01 F500.
M30
