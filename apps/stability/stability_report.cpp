// SPDX-License-Identifier: Apache-2.0
#include "apps/stability/stability_report.h"

#include "apps/stability/case_text.h"
#include "engine/gpu/instance.h"
#include "engine/gpu/physical_device.h"
#include "engine/types/error.h"
#include "engine/types/output_file.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

namespace fathom::stability {

namespace {

using Json = nlohmann::ordered_json;

Json number(double value) {
    return std::isfinite(value) ? Json(value) : Json(nullptr);
}

std::string cpuName() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with("model name") && line.find(": ") != std::string::npos) {
            return line.substr(line.find(": ") + 2);
        }
    }
    return "unknown CPU";
}

void write(const std::filesystem::path& file, const std::string& text) {
    OutputFile out(file);
    out.write(text);
    out.commit();
}

// Escapes a table cell: replaces line breaks and bars.
std::string cell(std::string words) {
    std::replace(words.begin(), words.end(), '\n', ' ');
    std::replace(words.begin(), words.end(), '|', '/');
    return words;
}

std::string tableOf(const std::vector<CaseResult>& results, Group group) {
    std::string table;
    size_t count = 0, held = 0;
    for (const CaseResult& r : results) {
        if (r.group == group) {
            ++count;
            held += r.outcome.holds() ? 1 : 0;
            table += "| " + r.name + " | " + comparison(r.outcome) + " | " +
                     (r.outcome.holds() ? "yes" : "**NO**") + " | " + num(r.seconds) + " | " +
                     cell(r.outcome.note) + " |\n";
        }
    }
    return count == 0 ? ""
                      : "\n## " + std::string(kGroupNames[static_cast<size_t>(group)]) + " (" +
                            std::to_string(held) + " of " + std::to_string(count) +
                            " hold)\n\n| case | figure and limit | holds | seconds | what was varied |\n" +
                            "|---|---|---|---|---|\n" + table;
}

} // namespace

std::string deviceDescription(const std::string& selector) {
    try {
        const gpu::Instance instance;
        return gpu::readFacts(gpu::choosePhysicalDevice(instance, selector)).name + "; " + cpuName();
    } catch (const Error&) {
        return "no Vulkan device; " + cpuName();
    }
}

bool allHold(const std::vector<CaseResult>& results) {
    return std::all_of(results.begin(), results.end(), [](const CaseResult& r) { return r.outcome.holds(); });
}

std::string toJson(const std::vector<CaseResult>& results, const std::string& device) {
    Json json = Json::object();
    json["cases"] = Json::array();
    for (const CaseResult& r : results) {
        json["cases"].push_back({{"name", r.name},
                                 {"group", kGroupNames[static_cast<size_t>(r.group)]},
                                 {"figure", number(r.outcome.figure)},
                                 {"unit", r.outcome.unit},
                                 {"limit", number(r.outcome.limit)},
                                 {"holds", r.outcome.holds()},
                                 {"note", r.outcome.note}});
    }
    json["holds"] = allHold(results);
    json["device"] = device;
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string toMarkdown(const std::vector<CaseResult>& results, const std::string& device) {
    size_t held = 0;
    double seconds = 0.0;
    for (const CaseResult& r : results) {
        held += r.outcome.holds() ? 1 : 0;
        seconds += r.seconds;
    }
    std::string text = "# Numerical stability\n\n" + std::to_string(held) + " of " +
                       std::to_string(results.size()) + " cases hold. Device: " + cell(device) + ". " +
                       num(seconds) +
                       " s in all.\n\nEach figure is measured; `figure <= limit` (or `>=`) is what must "
                       "hold. Units: 1 = a pure number.\n";
    for (size_t group = 0; group < std::size(kGroupNames); ++group) {
        text += tableOf(results, static_cast<Group>(group));
    }
    return text;
}

void writeReport(const std::filesystem::path& folder, const std::vector<CaseResult>& results,
                 const std::string& device) {
    write(folder / "stability.json", toJson(results, device));
    write(folder / "stability.md", toMarkdown(results, device));
}

} // namespace fathom::stability
