// SPDX-License-Identifier: Apache-2.0
// Points of pixels. Needs params, depth.glsl, transform.glsl.

// Camera-frame point [m] at depth z [m]. Rounded here, so that a difference of points is the same whether
// they come from shared memory, registers or directly.
vec3 pointAt(ivec2 at, float z) {
    precise vec2 beside = rayOf(uvec2(at)) * z;
    return vec3(beside, z);
}

// The point in base axes, relative to the origin [m]; w = z.
vec4 basePoint(ivec2 at, float z) {
    return vec4(transformPoint(params.baseTcamera, pointAt(at, z)), z);
}
