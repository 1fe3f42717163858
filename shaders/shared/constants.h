// SPDX-License-Identifier: Apache-2.0
// Ids of the specialisation constants. A name means the same in every shader, and C++ sets constants by these
// names. Flags are 0 or 1; constants that a shader does not declare are ignored.
#ifndef FATHOM_SHARED_CONSTANTS_H
#define FATHOM_SHARED_CONSTANTS_H
#include "shaders/shared/interop.h"
FATHOM_SHARED_BEGIN

FATHOM_CONST kSpecGroupSize = 0; // local_size_x, in every shader
// The camera and the scene.
FATHOM_CONST kSpecRays = 1;    // rays come from a table: distorted lens or fan
FATHOM_CONST kSpecFan = 2;     // pixels are beams at equal angles
FATHOM_CONST kSpecBeam = 3;    // each sphere grows by 3 sigma of its own point
FATHOM_CONST kSpecMoves = 4;   // the camera may move
FATHOM_CONST kSpecLens = 5;    // kLens value of the lens that points are projected through
FATHOM_CONST kSpecColour = 6;  // kColourNone, kColourRegistered or kColourLookedUp
FATHOM_CONST kSpecFormat = 7;  // kFormat value of the colour image
FATHOM_CONST kSpecWater = 8;   // colours are corrected for attenuation in water
FATHOM_CONST kSpecClasses = 9; // number of point classes; loops over them unroll
FATHOM_CONST kSpecBox = 10;    // some class has a box
FATHOM_CONST kSpecRange = 11;  // some class has a range gate
FATHOM_CONST kSpecGuidance = 12;
FATHOM_CONST kSpecSelfFilter = 13; // points inside the arm's spheres belong to no class
FATHOM_CONST kSpecThin = 14;       // points are removed within the error budget
FATHOM_CONST kSpecHold = 15;       // points out of view are held; `spheres` takes a kHold value
FATHOM_CONST kSpecLeaks = 16;      // neighbouring points may be a region radius apart
FATHOM_CONST kSpecTree = 17;       // the GPU query reads spheres and bounds
// The filter.
FATHOM_CONST kSpecRadius = 18;    // window (2 r + 1)^2; 0 = no filter
FATHOM_CONST kSpecEdge = 19;      // flying pixels are rejected
FATHOM_CONST kSpecIsolation = 20; // isolated pixels are rejected
FATHOM_CONST kSpecWeights = 21;   // a kWeights value
FATHOM_CONST kSpecTiled = 22;     // window from shared memory
FATHOM_CONST kSpecBlock = 23;     // one invocation per 4x4 sub-patch, window in registers
FATHOM_CONST kSpecPair = 24;      // two pixels per invocation
// The device.
FATHOM_CONST kSpecFour = 25;  // a texel holds four pixels, if the width is a multiple of four; a kFour value
FATHOM_CONST kSpecRows = 26;  // rows of four pixels per invocation
FATHOM_CONST kSpecWide = 27;  // a group covers four patches side by side
FATHOM_CONST kSpecKeep = 28;  // `classify` copies the depth to device memory for later passes
FATHOM_CONST kSpecLists = 29; // `classify` makes the patch lists
FATHOM_CONST kSpecSubPatchGroup = 30; // group size of the sub-patch passes
FATHOM_CONST kSpecTexels = 31;        // the memory of points is read as texels
FATHOM_CONST kSpecPack = 32;          // the host reads packed runs
FATHOM_CONST kSpecShared = 33;        // moments of sub-patches are merged in shared memory
// Measurements of the device.
FATHOM_CONST kSpecRounds = 35; // rounds of four multiply-adds per chain
FATHOM_CONST kSpecCopy = 36;   // 1: `stream` copies; 0: it sums

// Values of kSpecColour.
FATHOM_CONST kColourNone = 0, // no colour
    kColourRegistered = 1,    // registered to depth
    kColourLookedUp = 2;      // of a colour camera with its own lens
// Values of kSpecFour: the images whose texels hold four pixels.
FATHOM_CONST kFourNone = 0,  // none
    kFourDepth = 1,          // depth
    kFourDepthAndColour = 2; // depth and registered colour
// Values of kSpecFormat, those of ColourFormat.
FATHOM_CONST kFormatRgba = 0;
FATHOM_CONST kFormatYuyv = 1;
FATHOM_CONST kFormatUyvy = 2;
FATHOM_CONST kFormatRgb = 3;
FATHOM_CONST kFormatBgr = 4;
FATHOM_CONST kFormatPlanes = 5;
FATHOM_CONST kFormatJpegPlanes = 6;
// Values of kSpecWeights: how the filter computes exp(-t).
FATHOM_CONST kWeightsExponential = 0;
FATHOM_CONST kWeightsPolynomial = 1; // (1 - t / 16.68)^16
FATHOM_CONST kWeightsQuartic = 2;    // a polynomial of degree 4 near exp(-t / 16), to the power of 16
// Values of kSpecLens.
FATHOM_CONST kLensNone = 0,    // no distortion
    kLensPlain = 1,            // Brown-Conrady
    kLensRational = 2,         // a quotient of two polynomials
    kLensScaledTangential = 3, // p1 and p2 applied after the radial factor
    kLensEquidistant = 4;      // Kannala-Brandt
// Values of kSpecHold for `spheres`. On CPU devices, patches whose memory holds points have a dispatch of
// their own.
FATHOM_CONST kHoldNone = 0, // nothing is held
    kHoldWithoutPoints = 1, // patches that hold no point
    kHoldWithPoints = 2;    // patches that hold points

FATHOM_SHARED_END
#endif
