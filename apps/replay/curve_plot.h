// SPDX-License-Identifier: Apache-2.0
// One picture of curves over common axes, linear or logarithmic.
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

// 960 x 600 pixels. The labels of the axes carry the units; values that have no place (not finite, <= 0 on a
// logarithmic axis) are left out. Throws Error that names the file.
void writeCurvePlot(const std::filesystem::path& file, const std::string& title, const std::string& subtitle,
                    const std::vector<PlotCurve>& curves);

} // namespace fathom
