// SPDX-License-Identifier: Apache-2.0
// The growth that dropping a point requires of the remaining spheres. Needs params.glsl.
//
// Let q be a dropped point, p_i the four corner points of its cell, q' = sum l_i p_i their bilinear mean at
// q's place, V = sum l_i |p_i - q'|^2 and e = |q - q'|. Corner spheres of radius R' = sqrt((R + e)^2 + V)
// cover the sphere of q, since for every x, min_i |x - p_i|^2 <= sum l_i |x - p_i|^2 = |x - q'|^2 + V. So
// growing the corners by R' - R loses no part of the region, on any slope. On a flat square of spacing s the
// growth is s^2 / (4 R). A cell is thinned only when it is full of one class and the growth is within the
// budget: the 4x4 cell if possible, else each 2x2 cell.

// The corners of a cell, relative to its own corner: sum l |p - mean|^2 = sum l |p|^2 - |mean|^2, which keeps
// its digits because the points are near each other.
struct Corners {
    vec3 own, right, below, across; // the last three relative to the first
    vec3 squares;                   // |right|^2, |below|^2, |across|^2
};

Corners cornersOf(vec3 own, vec3 right, vec3 below, vec3 across) {
    vec3 b = right - own, d = below - own, e = across - own;
    return Corners(own, b, d, e, vec3(dot(b, b), dot(d, d), dot(e, e)));
}

// R'^2 - R^2 that dropping point q requires, at (tx, ty) in the cell, 0..1 each.
float requiredSquare(vec3 q, Corners c, float tx, float ty, float radius) {
    vec3 l = vec3(tx * (1.0 - ty), (1.0 - tx) * ty, tx * ty);
    vec3 mean = l.x * c.right + l.y * c.below + l.z * c.across;
    float spread = l.x * c.squares.x + l.y * c.squares.y + l.z * c.squares.z - dot(mean, mean);
    float off = distance(q - c.own, mean);
    return off * (2.0 * radius + off) + max(spread, 0.0);
}

// R' - R, computed without cancellation, rounded up to a whole step, never 0; -1 = over the budget. The added
// 1e-4 exceeds the rounding error of the steps.
float growthOf(float most, float radius) {
    float growth = most / (sqrt(radius * radius + most) + radius) * 1.0001 + 1e-8;
    precise float stepped = min(ceil(growth * growthStepsPerMetre()), float(kGrowthSteps)) * growthStep();
    return growth <= errorBudget() ? stepped : -1.0;
}
