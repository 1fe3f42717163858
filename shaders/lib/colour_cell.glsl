// SPDX-License-Identifier: Apache-2.0
// A point in the colour image, and the cell of that image in which `occlusion` keeps the nearest depth.

// q: in the frame of the colour camera [m], in front of it.
ivec2 colourPixel(vec3 q) {
    return ivec2(round(projectPoint(q, params.colourLens, params.colourDistortion, colourK3(), params.colourLensDivisor)));
}

bool isOutsideColour(ivec2 at) {
    return any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, ivec2(colourSize())));
}

uint cellOfColour(ivec2 at) {
    uvec2 cell = uvec2(at) / cellEdge();
    return cell.y * cellsAcross() + cell.x;
}
