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

bool passesColour(uint rgba, vec4 hue, vec4 satLight) {
    ivec3 c = ivec3(rgba & 255u, (rgba >> 8) & 255u, (rgba >> 16) & 255u);
    int hi = max(c.r, max(c.g, c.b)), lo = min(c.r, min(c.g, c.b));
    int d = hi - lo, sum = hi + lo;
    if (!inBand(float(sum), satLight.z, satLight.w, 510.0)) {
        return false;
    }
    if (d == 0 ? satLight.x > 0.0 : !inBand(float(d), satLight.x, satLight.y, float(255 - abs(sum - 255)))) {
        return false; // grey, black and white have no saturation
    }
    if (hue.z == 0.0) {
        return true;
    }
    if (d == 0) {
        return false; // grey has no hue
    }
    int sector = c.r == hi ? c.g - c.b : (c.g == hi ? c.b - c.r + 2 * d : c.r - c.g + 4 * d);
    sector += sector < 0 ? 6 * d : 0;
    float h = float(60 * sector), scale = float(d); // hue x d
    if (hue.w == 0.0) {
        return inBand(h, hue.x, hue.y, scale);
    }
    return h >= hue.x * scale - slackOf(hue.x * scale) || h <= hue.y * scale + slackOf(hue.y * scale);
}
