// SPDX-License-Identifier: Apache-2.0
#include "engine/model/import_triangles.h"

#include <algorithm>
#include <array>

namespace fathom {

namespace {

bool take(ReaderPipe& pipe, ImportedTriangles& out) {
    TrianglesHeader head;
    if (!pipe.readText(out.fault) || !pipe.read(&head, sizeof head) || head.points > kMaxImportedPoints ||
        head.triangles > kMaxImportedPoints) {
        return false;
    }
    out.mesh.points.resize(head.points);
    out.mesh.triangles.resize(head.triangles);
    const auto sound = [&](const std::array<uint32_t, 3>& corners) {
        return std::max({corners[0], corners[1], corners[2]}) < head.points;
    };
    return pipe.read(out.mesh.points.data(), head.points * sizeof(dvec3)) &&
           pipe.read(out.mesh.triangles.data(), head.triangles * sizeof out.mesh.triangles[0]) &&
           std::all_of(out.mesh.triangles.begin(), out.mesh.triangles.end(), sound);
}

} // namespace

ImportedTriangles importTriangles(const std::filesystem::path& file, const ReaderOptions& options) {
    ImportedTriangles out;
    const ReaderEnd end = runReader("mesh", file, options, [&](ReaderPipe& pipe) { return take(pipe, out); });
    refuseForeign(options, end);
    if (!end.whole) {
        out.mesh = {};
        out.fault = broken("mesh reader", end);
    }
    return out;
}

} // namespace fathom
