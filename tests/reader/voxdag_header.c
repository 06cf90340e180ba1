// The implementation of include/voxdag.h, compiled as C99.
#define VOXDAG_IMPLEMENTATION
#include "voxdag.h"
