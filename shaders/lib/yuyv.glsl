// SPDX-License-Identifier: Apache-2.0
// BT.601, limited range. Returns the same whole bytes as engine/types/yuyv.cpp, since every step is exact in
// float32.
vec3 rgbOfYuv(uint luma, uint blueDifference, uint redDifference) {
    float c = 298.0 * (float(luma) - 16.0) + 128.0;
    float u = float(blueDifference) - 128.0, v = float(redDifference) - 128.0;
    vec3 rgb = c + vec3(409.0 * v, -100.0 * u - 208.0 * v, 516.0 * u);
    return clamp(floor(rgb * (1.0 / 256.0)), 0.0, 255.0);
}
