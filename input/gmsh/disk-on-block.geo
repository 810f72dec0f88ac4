// A disk of radius 10 on a block of 20 x 20; half of the scene, x >= 0. Units mm and N.
R = 10; size = 20;
near = 0.04; far = 4;

// the disk: a quarter of it, from the lowest point outwards
Point(1) = {0, 0, 0, near};
Point(2) = {1.2, R - Sqrt(R^2 - 1.2^2), 0, near};
Point(3) = {R, R, 0, far};
Point(4) = {0, R, 0, far};
Circle(1) = {1, 4, 2};
Circle(2) = {2, 4, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};

// the block
Point(5) = {0, -size, 0, far};
Point(6) = {size, -size, 0, far};
Point(7) = {size, 0, 0, far};
Point(8) = {1.2, 0, 0, near};
Point(9) = {0, 0, 0, near};
Line(5) = {5, 6};
Line(6) = {6, 7};
Line(7) = {7, 8};
Line(8) = {8, 9};
Line(9) = {9, 5};
Curve Loop(2) = {5, 6, 7, 8, 9};
Plane Surface(2) = {2};

Physical Surface("disk") = {1};
Physical Surface("block") = {2};
Physical Curve("disk-bottom") = {1};
Physical Curve("disk-top") = {3};
Physical Curve("block-top") = {8};
Physical Curve("block-base") = {5};
Physical Curve("middle") = {4, 9};

Mesh.ElementOrder = 2;
