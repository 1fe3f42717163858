// SPDX-License-Identifier: Apache-2.0
// Draws curves over common axes, linear or logarithmic, as a PNG file.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace fathom {

struct PlotCurve {
    std::string name, xLabel, yLabel;
    std::vector<double> x, y;
    bool logX = false, logY = false;
};

// 960 x 600 pixels. Axis labels include the units. Skips values that are not finite, or <= 0 on a logarithmic
// axis. Throws Error that names the file.
void writeCurvePlot(const std::filesystem::path& file, const std::string& title, const std::string& subtitle,
                    const std::vector<PlotCurve>& curves);

} // namespace fathom
