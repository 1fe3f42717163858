#version 460
// SPDX-License-Identifier: Apache-2.0
// Nearest depth in each small cell of the colour image. `classify` uses it to detect points that a nearer
// surface hides from the colour camera (parallax). Unregistered cameras only.
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/constants.h"
#include "shaders/shared/frame_params.h"

layout(local_size_x_id = kSpecGroupSize) in;
layout(constant_id = kSpecRays) const uint kRays = 0;

layout(std140, binding = 0) uniform Params { FrameParams params; };
layout(binding = 1) uniform usamplerBuffer depths; // uint16 per pixel
layout(std430, binding = 2) readonly buffer Rays { vec2 rays[]; };
// Bits of the smallest z; 0xffffffff = none.
layout(std430, binding = 3) buffer Cells { uint nearest[]; };

#include "shaders/lib/params.glsl"
#include "shaders/lib/depth.glsl"
#include "shaders/lib/lens.glsl"
#include "shaders/lib/colour_cell.glsl"
#include "shaders/lib/transform.glsl"

void main() {
    uint pixel = gl_GlobalInvocationID.x;
    if (pixel >= depthWidth() * depthSize().y) {
        return;
    }
    float z = depthAt(pixel);
    if (z == 0.0) {
        return;
    }
    vec3 p = transformPoint(params.colourTdepth, vec3(rayOf(uvec2(pixel % depthWidth(), pixel / depthWidth())) * z, z));
    if (p.z <= 0.0) {
        return;
    }
    ivec2 at = colourPixel(p);
    if (isOutsideColour(at)) {
        return;
    }
    atomicMin(nearest[cellOfColour(at)], floatBitsToUint(p.z));
}
