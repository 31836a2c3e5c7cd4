// The overlap test of wide trees for the instruction set that all code of the project uses.
#include "collision/exact/wide_overlap.h"
#define GPS_OVERLAP_TEST overlapBaseline
#include "collision/exact/wide_overlap_body.h"
