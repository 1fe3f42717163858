// SPDX-License-Identifier: Apache-2.0
// What leaving a point out asks of the spheres that stay. Needs params.
//
// A dropped point q with q' = sum l_i p_i, the bilinear mean of its cell's four corner points, V = sum l_i |p_i - q'|^2 and
// e = |q - q'| is covered by these corners when they have the radius R' = sqrt((R + e)^2 + V): for every x,
// min_i |x - p_i|^2 <= sum l_i |x - p_i|^2 = |x - q'|^2 + V. So corners that grow by R' - R lose nothing of the region, in any
// direction, on any slope; on a flat square of spacing s the growth is s^2 / (4 R). A cell is thinned only when it is full of
// one class and the growth stays within the budget: first 4x4, else each 2x2.

// The corners of a cell about its own one; sum l |p - mean|^2 = sum l |p|^2 - |mean|^2, and neighbours are near enough to keep its
// digits.
struct Corners {
    vec3 own, right, below, across; // the last three about the first
    vec3 squares;                   // |right|^2, |below|^2, |across|^2
};

Corners cornersOf(vec3 own, vec3 right, vec3 below, vec3 across) {
    vec3 b = right - own, d = below - own, e = across - own;
    return Corners(own, b, d, e, vec3(dot(b, b), dot(d, d), dot(e, e)));
}

// R'^2 - R^2 that the point q asks for, at (tx, ty) of the cell, 0..1 each.
float askedBy(vec3 q, Corners c, float tx, float ty, float radius) {
    vec3 l = vec3(tx * (1.0 - ty), (1.0 - tx) * ty, tx * ty);
    vec3 mean = l.x * c.right + l.y * c.below + l.z * c.across;
    float spread = l.x * c.squares.x + l.y * c.squares.y + l.z * c.squares.z - dot(mean, mean);
    float off = distance(q - c.own, mean);
    return off * (2.0 * radius + off) + max(spread, 0.0);
}

// R' - R without the cancellation of two nearly equal radii, outward to a whole step and never 0; -1 = not within the budget. What
// the steps are rounded by is less than the 1e-4 that are added.
float growthOf(float most, float radius) {
    float growth = most / (sqrt(radius * radius + most) + radius) * 1.0001 + 1e-8;
    precise float stepped = min(ceil(growth * params.steps.w), float(kGrowthSteps)) * params.steps.z;
    return growth <= params.filterParams.y ? stepped : -1.0;
}
