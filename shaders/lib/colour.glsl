// SPDX-License-Identifier: Apache-2.0
// Hue, saturation and lightness gates on stored sRGB bytes (hexagonal HSL), decided on the integers behind the
// fractions: with m = max, d = max - min, hue = 60 (k d + difference) / d, S = d / (255 - |max + min - 255|),
// L = (max + min) / 510. Products instead of quotients, and a slack of what float32 rounds away of a bound and of the product,
// make the inclusive bounds hold on every device: a colour exactly on a bound is inside.

float slackOf(float product) {
    return 1e-4 + 1.3e-7 * product;
}

bool inBand(float value, float lo, float hi, float scale) {
    return value >= lo * scale - slackOf(lo * scale) && value <= hi * scale + slackOf(hi * scale);
}

// The integers behind hue, saturation and lightness, once a pixel; every class then compares products.
struct Hsl {
    float sum;      // max + min = 510 L
    float d;        // max - min = S x satScale
    float satScale;
    float hue;      // hue x d [degree]
};

Hsl hslOf(uint rgba) {
    ivec3 c = ivec3(rgba & 255u, (rgba >> 8) & 255u, (rgba >> 16) & 255u);
    int hi = max(c.r, max(c.g, c.b)), lo = min(c.r, min(c.g, c.b));
    int d = hi - lo, sum = hi + lo;
    int sector = c.r == hi ? c.g - c.b : (c.g == hi ? c.b - c.r + 2 * d : c.r - c.g + 4 * d);
    sector += sector < 0 ? 6 * d : 0;
    return Hsl(float(sum), float(d), float(255 - abs(sum - 255)), float(60 * sector));
}

bool passesColour(Hsl c, vec4 hue, vec4 satLight) {
    bool light = inBand(c.sum, satLight.z, satLight.w, 510.0);
    // grey, black and white have no saturation
    bool saturated = c.d == 0.0 ? satLight.x <= 0.0 : inBand(c.d, satLight.x, satLight.y, c.satScale);
    bool above = c.hue >= hue.x * c.d - slackOf(hue.x * c.d), below = c.hue <= hue.y * c.d + slackOf(hue.y * c.d);
    bool inHue = c.d != 0.0 && (hue.w != 0.0 ? above || below : above && below); // grey has no hue
    return light && saturated && (hue.z == 0.0 || inHue);
}
