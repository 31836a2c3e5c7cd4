// The tests of wide trees for the instruction set that all code of the project uses.
#include "collision/trees/wide_tests.h"
#define GPS_OVERLAP_TEST overlapBaseline
#define GPS_NEAR_TRIANGLES_TEST nearTrianglesBaseline
#include "collision/trees/wide_overlap_body.h"
#include "collision/trees/wide_triangles_body.h"
