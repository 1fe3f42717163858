// SPDX-License-Identifier: Apache-2.0
// Hue, saturation and lightness gates on stored sRGB bytes (hexagonal HSL), evaluated on the integers in the
// fractions: with d = max - min, hue = 60 (k d + difference) / d, S = d / (255 - |max + min - 255|), L = (max
// + min) / 510. Bounds are compared with products instead of quotients, with a slack for the float32 rounding
// of bounds (subtracted by the CPU) and products. So a colour exactly on a bound is inside on every device.
// No branch: a CPU device executes both sides of each.

// The integers behind hue, saturation and lightness, computed once per pixel for all classes.
struct Hsl {
    float sum;      // max + min = 510 L
    float d;        // max - min = S x satScale
    float satScale;
    float hue;      // hue x d [degree]
};

Hsl hslOf(vec3 c) {
    float hi = max(c.r, max(c.g, c.b)), lo = min(c.r, min(c.g, c.b));
    float d = hi - lo, sum = hi + lo;
    float sector = c.r == hi ? c.g - c.b : (c.g == hi ? c.b - c.r + 2.0 * d : c.r - c.g + 4.0 * d);
    sector += sector < 0.0 ? 6.0 * d : 0.0;
    return Hsl(sum, d, 255.0 - abs(sum - 255.0), 60.0 * sector);
}

// Distance inside the gates; below -1e-4: outside. Grey, black and white have neither hue nor saturation.
float insideGates(Hsl c, ClassParams g) {
    float light = min(c.sum - g.satLight.z, g.satLight.w - c.sum);
    float above = c.hue - g.hue.x * c.d, below = g.hue.y * c.d - c.hue;
    float hue = g.hue.z != 0.0 ? max(above, below) : min(above, below); // wraps through 0, or not
    float saturation = min(c.d - g.satLight.x * c.satScale, g.satLight.y * c.satScale - c.d);
    return min(light, c.d == 0.0 ? g.hue.w : min(hue, saturation));
}
