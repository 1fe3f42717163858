// SPDX-License-Identifier: Apache-2.0
#include "apps/spheres/spheres_report.h"

#include "apps/output/curve_plot.h"
#include "engine/types/log.h"
#include "engine/types/output_file.h"

#include <iomanip>
#include <map>
#include <nlohmann/json.hpp>

namespace fathom {

namespace {

void note(std::ostream& out, size_t count, const std::string& words) {
    if (count > 0) {
        out << "        " << count << " " << words << "\n";
    }
}

nlohmann::json jsonOf(const CoverRow& row) {
    const CoverMeasure& m = row.measure;
    nlohmann::json j = {{"name", row.name},
                        {"leaves", row.leaves},
                        {"protrusion_max_m", m.protrusionMax},
                        {"protrusion_mean_m", m.protrusionMean},
                        {"protrusion_bound_m", m.bound},
                        {"surface_samples", m.surfaceSamples},
                        {"samples_outside", m.outside},
                        {"deepest_gap_m", m.deepestGap},
                        {"inside_covered", m.insideCovered},
                        {"seconds", row.seconds}};
    j["volume_ratio"] = m.volumeRatio > 0.0 ? nlohmann::json(m.volumeRatio) : nlohmann::json(nullptr);
    return j;
}

} // namespace

void warnOfMesh(const std::filesystem::path& file, const LoadedMesh& loaded) {
    if (!loaded.warning.empty()) {
        log::warn("{}: {}; set the unit with --scale", file.string(), loaded.warning);
    }
    for (const std::string& text : loaded.notes) {
        log::warn("{}: {}", file.string(), text);
    }
}

void printMesh(std::ostream& out, const LoadedMesh& loaded) {
    const MeshFacts& f = loaded.facts;
    const dvec3 size = loaded.mesh.high() - loaded.mesh.low();
    out << "mesh    " << loaded.mesh.triangles.size() << " faces, " << f.parts << " pieces, "
        << std::setprecision(4) << 1e3 * size.x << " x " << 1e3 * size.y << " x " << 1e3 * size.z << " mm, "
        << (f.closed() ? "closed" : "not closed: no inside, both sides of the surface count") << "\n";
    note(out, f.doubled, "duplicate faces dropped");
    note(out, f.noArea, "faces without area dropped");
    note(out, f.turned, "faces turned outwards");
    note(out, f.openEdges, "open edges");
    note(out, f.crowdedEdges, "edges of three faces or more");
    note(out, f.strayParts, "stray pieces dropped");
}

void printRows(std::ostream& out, const std::vector<CoverRow>& rows) {
    out << std::left << std::setw(10) << "method" << std::right << std::setw(7) << "leaves" << std::setw(10)
        << "max mm" << std::setw(10) << "mean mm" << std::setw(11) << "proven mm" << std::setw(10)
        << "outside" << std::setw(9) << "gap mm" << std::setw(9) << "volume" << std::setw(10) << "inside"
        << std::setw(8) << "s\n";
    for (const CoverRow& row : rows) {
        const CoverMeasure& m = row.measure;
        out << std::left << std::setw(10) << row.name << std::right << std::setw(7) << row.leaves
            << std::fixed << std::setprecision(3) << std::setw(10) << 1e3 * m.protrusionMax << std::setw(10)
            << 1e3 * m.protrusionMean << std::setw(11) << 1e3 * m.bound << std::setw(10) << m.outside
            << std::setw(9) << 1e3 * std::max(0.0, m.deepestGap) << std::setprecision(2) << std::setw(9)
            << m.volumeRatio << std::setprecision(4) << std::setw(10) << m.insideCovered
            << std::setprecision(1) << std::setw(7) << row.seconds << "\n"
            << std::defaultfloat << std::setprecision(6);
    }
}

void writeErrorPlot(const std::filesystem::path& file, const std::string& title,
                    const std::vector<CoverRow>& rows) {
    std::map<std::string, PlotCurve> curves;
    for (const CoverRow& row : rows) {
        for (const bool worst : {true, false}) {
            auto& curve = curves[row.name + (worst ? ", max" : ", mean")];
            curve.name = row.name + (worst ? ", max" : ", mean");
            curve.xLabel = "leaf spheres";
            curve.yLabel = "protrusion [m]";
            curve.logX = curve.logY = true;
            curve.x.push_back(static_cast<double>(row.leaves));
            curve.y.push_back(worst ? row.measure.protrusionMax : row.measure.protrusionMean);
        }
    }
    std::vector<PlotCurve> drawn;
    for (auto& [name, curve] : curves) {
        drawn.push_back(std::move(curve));
    }
    writeCurvePlot(file, title, "protrusion of the spheres from the mesh", drawn);
}

void writeReportJson(const std::filesystem::path& file, const LoadedMesh& loaded,
                     const std::vector<CoverRow>& rows) {
    const MeshFacts& f = loaded.facts;
    const dvec3 size = loaded.mesh.high() - loaded.mesh.low();
    nlohmann::json j;
    j["mesh"] = {{"faces", loaded.mesh.triangles.size()},
                 {"size_m", {size.x, size.y, size.z}},
                 {"pieces", f.parts},
                 {"closed", f.closed()},
                 {"doubled_faces", f.doubled},
                 {"open_edges", f.openEdges},
                 {"crowded_edges", f.crowdedEdges},
                 {"stray_pieces", f.strayParts}};
    j["covers"] = nlohmann::json::array();
    for (const CoverRow& row : rows) {
        j["covers"].push_back(jsonOf(row));
    }
    writeSphereText(file, j.dump(2) + "\n");
}

void writeSphereText(const std::filesystem::path& file, const std::string& text) {
    OutputFile out(file);
    out.write(text);
    out.commit();
}

} // namespace fathom
