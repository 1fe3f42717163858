// SPDX-License-Identifier: Apache-2.0
// Red, green and blue of pixels, from the bytes that the camera sends: the same whole bytes as
// engine/types/colour_format.cpp, since every step is exact in float32. Needs `colours`, params.glsl and
// kFormat.

// BT.601, limited range.
vec3 rgbOfYuv(uint luma, uint blueDifference, uint redDifference) {
    float c = 298.0 * (float(luma) - 16.0) + 128.0;
    float u = float(blueDifference) - 128.0, v = float(redDifference) - 128.0;
    vec3 rgb = c + vec3(409.0 * v, -100.0 * u - 208.0 * v, 516.0 * u);
    return clamp(floor(rgb * (1.0 / 256.0)), 0.0, 255.0);
}

// BT.601, full range (JPEG).
vec3 rgbOfJpeg(uint luma, uint blueDifference, uint redDifference) {
    float u = float(blueDifference) - 128.0, v = float(redDifference) - 128.0;
    vec3 change = vec3(91881.0 * v, -22554.0 * u - 46802.0 * v, 116130.0 * u) + 32768.0;
    return clamp(float(luma) + floor(change * (1.0 / 65536.0)), 0.0, 255.0);
}

vec3 rgbOfPlanes(uint luma, uint blueDifference, uint redDifference) {
    if (kFormat == kFormatJpegPlanes) {
        return rgbOfJpeg(luma, blueDifference, redDifference);
    }
    return rgbOfYuv(luma, blueDifference, redDifference);
}

const bool kPairs = kFormat == kFormatYuyv || kFormat == kFormatUyvy;
const bool kBytes = kFormat == kFormatRgb || kFormat == kFormatBgr;

uint wordAt(uint byte) {
    return texelFetch(colours, int(byte >> 2)).x;
}

uint byteAt(uint byte) {
    return wordAt(byte) >> (8u * (byte & 3u)) & 255u;
}

// Places of the first samples of U and V of a pixel [bytes].
uvec2 chromaAt(uvec2 at) {
    uint place = (at.y >> chromaShare().y) * chromaStep() + (at.x >> chromaShare().x << chromaSpacing());
    return chromaPlanes() + place;
}

vec3 colourAt(uvec2 at) {
    uint pixel = at.y * colourSize().x + at.x;
    if (kPairs) {
        uvec4 pair = texelFetch(colours, int(at.y * ((colourSize().x + 1u) >> 1) + (at.x >> 1)));
        pair = kFormat == kFormatUyvy ? pair.yxwz : pair;
        return rgbOfYuv((at.x & 1u) == 0 ? pair.x : pair.z, pair.y, pair.w);
    }
    if (kBytes) {
        vec3 bytes = vec3(byteAt(3u * pixel), byteAt(3u * pixel + 1u), byteAt(3u * pixel + 2u));
        return kFormat == kFormatBgr ? bytes.zyx : bytes;
    }
    if (kFormat == kFormatPlanes || kFormat == kFormatJpegPlanes) {
        uvec2 chroma = chromaAt(at);
        return rgbOfPlanes(byteAt(at.y * lumaStep() + at.x), byteAt(chroma.x), byteAt(chroma.y));
    }
    return vec3(texelFetch(colours, int(pixel)).xyz);
}

vec3[4] fourOfPairs(uint pixel) {
    const uint luma = kFormat == kFormatUyvy ? 8u : 0u; // bits
    uvec4 words = texelFetch(colours, int(pixel >> 2));
    vec3 rgb[4];
    [[unroll]] for (uint k = 0; k < 4u; ++k) {
        uint pair = words[k / 2u];
        rgb[k] = rgbOfYuv(pair >> (16u * (k & 1u) + luma) & 255u, pair >> (8u - luma) & 255u, pair >> (24u - luma) & 255u);
    }
    return rgb;
}

vec3[4] fourOfBytes(uint pixel) {
    uint words[3];
    [[unroll]] for (uint i = 0; i < 3u; ++i) {
        words[i] = wordAt(3u * pixel + 4u * i);
    }
    vec3 rgb[4];
    [[unroll]] for (uint k = 0; k < 4u; ++k) {
        [[unroll]] for (uint c = 0; c < 3u; ++c) {
            uint byte = 3u * k + (kFormat == kFormatBgr ? 2u - c : c);
            rgb[k][c] = float(words[byte / 4u] >> (8u * (byte % 4u)) & 255u);
        }
    }
    return rgb;
}

// One word per plane has the samples of all four pixels (ColourPlanes).
vec3[4] fourOfPlanes(uvec2 at) {
    uvec2 chroma = chromaAt(at);
    uint luma = wordAt(at.y * lumaStep() + at.x);
    uint blue = wordAt(chroma.x) >> (8u * (chroma.x & 3u)), red = wordAt(chroma.y) >> (8u * (chroma.y & 3u));
    vec3 rgb[4];
    [[unroll]] for (uint k = 0; k < 4u; ++k) {
        uint bits = 8u * (k >> chromaShare().x << chromaSpacing());
        rgb[k] = rgbOfPlanes(luma >> (8u * k) & 255u, blue >> bits & 255u, red >> bits & 255u);
    }
    return rgb;
}

// Four adjacent pixels of a row, from a multiple of four on, if rows have a multiple of four pixels.
vec3[4] fourColoursAt(uvec2 at) {
    uint pixel = at.y * colourSize().x + at.x;
    if (kPairs) {
        return fourOfPairs(pixel);
    }
    if (kBytes) {
        return fourOfBytes(pixel);
    }
    if (kFormat == kFormatPlanes || kFormat == kFormatJpegPlanes) {
        return fourOfPlanes(at);
    }
    uvec4 words = texelFetch(colours, int(pixel >> 2));
    vec3 rgb[4];
    [[unroll]] for (uint k = 0; k < 4u; ++k) {
        rgb[k] = vec3(words[k] & 255u, words[k] >> 8 & 255u, words[k] >> 16 & 255u);
    }
    return rgb;
}
