// SPDX-License-Identifier: Apache-2.0
// Names for the components of FrameParams, which shared/frame_params.h describes. Needs params.

// Sizes in pixels, patches, or occlusion cells of the colour image.
uvec2 depthSize() { return params.size.xy; }
uint depthWidth() { return params.size.x; }
uint patchesAcross() { return params.size.z; }
uint patchCount() { return params.size.z * params.size.w; }
uvec2 colourSize() { return params.colourSize.xy; }
uint cellsAcross() { return params.colourSize.z; }
uint cellEdge() { return params.colourSize.w; }

// Depth and lenses.
uint smallestRaw() { return params.depthBand.x; }
uint largestRaw() { return params.depthBand.y; }
float metresPerUnit() { return params.depthAndEdges.z; }
vec2 opticalCentre() { return params.lens.zw; } // [pixels]
vec2 rayStep() { return params.steps.xy; }      // per pixel
float depthK3() { return params.depthAndEdges.x; }
float colourK3() { return params.depthAndEdges.y; }
vec3 cameraCentre() { return vec3(params.baseTcamera[0].w, params.baseTcamera[1].w, params.baseTcamera[2].w); }

// Point classes: masks have one bit per class.
uint classCount() { return params.depthBand.z; }
uint forbiddenMask() { return params.depthBand.w; }
uint darkMask() { return params.chroma.w; } // classes that test colour while the colour image is dark
uint classOrder() { return params.time.w; }  // forbidden classes, 4 bits each

// Times [us]: captures of this frame and the previous one (both wrap), and how long points are held.
uint captureTime() { return params.time.x; }
uint previousTime() { return params.time.z; }
uint holdTime() { return params.time.y; }

// Noise and implausible depth.
float depthSigma(float z) { return params.noise.x + params.noise.y * z * z; } // [m]
float sigmasOfDifference() { return params.noise.z; }
float edgeJump() { return params.depthAndEdges.w; }         // relative
float isolationDistance() { return params.filterParams.z; } // [m]
float isolationSlope() { return params.filterParams.w; }    // [m] per metre of z

// Filter and thinning.
float filterSharpness() { return params.filterParams.x; } // 1 / (2 sigma^2) [1/m^2]
float filterLimit() { return params.noise.w; }            // [m] most that the filter moves a point
float errorBudget() { return params.filterParams.y; }     // [m]
float growthStep() { return params.steps.z; }             // [m]
float growthStepsPerMetre() { return params.steps.w; }

// Estimates: depths averaged over frames. Frames are numbered; 0 = none.
uint frameNumber() { return params.memory.x; }
uint estimatesFrom() { return params.memory.y; } // number of that frame
uint mostAveraged() { return params.memory.z; }  // [frames]
uint mostMissed() { return params.memory.w; }    // [frames]
float jumpLimit(float sigma) { return min(params.memoryGates.x * sigma, params.memoryGates.y); }         // [m]
float driftLimit(float sigma) { return min(params.memoryGates.z * sigma, params.memoryGates.w); }        // [m]
float unshownChange(float sigma) { return min(params.memoryLimits.x * sigma, params.memoryLimits.y); } // [m]
float movedPoseVariance() { return params.memoryLimits.z; } // [m^2]
uint cameraMoved() { return uint(params.memoryLimits.w); } // 1: since the frame that the estimates come from

// Colour. In planes: bytes between rows of luma and of chroma, where U and V begin, log2 of the columns and
// rows that share a sample, and log2 of the bytes between samples.
vec3 attenuation() { return params.water.xyz; } // of stored red, green, blue [1/m]
uint lumaStep() { return params.planes.x; }
uint chromaStep() { return params.planes.w; }
uvec2 chromaPlanes() { return params.planes.yz; }
uvec2 chromaShare() { return params.chroma.xy; }
uint chromaSpacing() { return params.chroma.z; }
