// SPDX-License-Identifier: Apache-2.0
#include "apps/profile/report.h"

#include "apps/output/csv.h"
#include "apps/profile/frame_sequence.h"
#include "engine/types/output_file.h"
#include "engine/types/processors.h"
#include "engine/types/version.h"

#include <cstdlib>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>

namespace fathom::profile {

namespace {

using Json = nlohmann::ordered_json;

#ifdef FATHOM_SANITIZED
constexpr const char* kBuild = "sanitized build: the times below are meaningless";
#elif defined(NDEBUG)
constexpr const char* kBuild = "release";
#else
constexpr const char* kBuild = "build without optimisation: the times below are meaningless";
#endif

std::string firstMatch(const std::string& file, const std::string& key) {
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);) {
        if (line.starts_with(key)) {
            const size_t at = line.find_first_not_of(" \t:", key.size());
            return at == std::string::npos ? "" : line.substr(at);
        }
    }
    return "unknown";
}

std::string word(std::string text) { // CSV text without commas, quotes or line breaks
    for (char& c : text) {
        c = c == ',' ? ';' : c == '"' || c == '\n' ? ' ' : c;
    }
    return text;
}

std::vector<std::pair<std::string, double>> timesOf(const Cost& cost) {
    std::vector<std::pair<std::string, double>> out;
    const auto add = [&](const std::string& name, const Spread& s) {
        const double none = std::numeric_limits<double>::quiet_NaN();
        out.push_back({name + "_p50_ms", s ? s.p50 : none});
        out.push_back({name + "_p90_ms", s ? s.p90 : none});
        out.push_back({name + "_p99_ms", s ? s.p99 : none});
    };
    add("gpu", cost.gpu);
    add("submit_to_result", cost.submit);
    add("cpu", cost.cpu);
    add("wall", cost.wall);
    return out;
}

int64_t repeatsOf(const Cost& cost) {
    return static_cast<int64_t>(
        std::max({cost.gpu.count, cost.submit.count, cost.cpu.count, cost.wall.count}));
}

Json number(double value) {
    return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json rowJson(const Study& study, const StudyRow& row) {
    Json out;
    out["source"] = row.source;
    out["setting"] = row.setting;
    out["default"] = row.isDefault;
    out["on_front"] = row.onFront;
    out["error"] = number(row.error);
    for (const auto& [name, value] : timesOf(row.cost)) {
        out[name] = number(value);
    }
    out["repeats"] = repeatsOf(row.cost);
    for (size_t i = 0; i < study.moreNames.size(); ++i) {
        out[study.moreNames[i]] = i < row.more.size() ? number(row.more[i]) : Json(nullptr);
    }
    return out;
}

// The verdict for a default row; "-" for other rows. A study without defaults gives its reason in every row.
std::string judgementOf(const Study& study, const StudyRow& row) {
    for (const Verdict& v : study.verdicts) {
        if (row.isDefault && v.source == row.source && v.setting == row.setting) {
            return v.words;
        }
    }
    return study.noDefault.empty() ? "-" : study.noDefault;
}

Json defaultsJson(const Study& study) {
    Json out = Json::array();
    for (const Verdict& v : study.verdicts) {
        Json one;
        one["source"] = v.source;
        one["setting"] = v.setting;
        one["on_front"] = v.onFront;
        one["words"] = v.words;
        out.push_back(std::move(one));
    }
    return out;
}

Json studyJson(const Study& study) {
    Json s;
    s["name"] = study.name;
    s["title"] = study.title;
    s["verified"] = study.verified;
    s["served"] = study.served;
    s["error"] = study.errorName;
    s["error_unit"] = study.errorUnit;
    s["time"] = study.timeName;
    s["defaults"] = defaultsJson(study);
    s["no_default"] = study.noDefault.empty() ? Json(nullptr) : Json(study.noDefault);
    s["findings"] = study.findings;
    s["rows"] = Json::array();
    for (const StudyRow& row : study.rows) {
        s["rows"].push_back(rowJson(study, row));
    }
    return s;
}

std::string nowInUtc() {
    const std::time_t now = std::time(nullptr);
    std::tm utc{};
    gmtime_r(&now, &utc);
    char text[32];
    std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
    return text;
}

// Settings that affect a table and that a scene file can change. Studies that vary one of them record it in
// their rows.
Facts sceneFacts(const gpu::Device& device, const Settings& settings) {
    const Scene scene = studyScene(settings);
    std::string radii;
    for (const FixtureClass& f : scene.fixtures) {
        radii +=
            f.role == Role::Forbidden && f.isPoints() ? (radii.empty() ? "" : " ") + digits(f.radius) : "";
    }
    const Plan plan = makePlan(scene, wallFrame(640, 480, 1.0).camera, 1, device.facts());
    return {{"filter_radius_pixels", std::to_string(scene.filter.radius)},
            {"filter_sigma_m", digits(scene.filter.sigma)},
            {"filter_edge", digits(scene.filter.edge)},
            {"region_radius_m", radii.empty() ? "no forbidden class" : radii},
            {"error_budget_m", digits(scene.errorBudget)},
            {"hold_s", digits(scene.holdSeconds)},
            {"publishers", std::to_string(plan.publishers)}};
}

} // namespace

Facts runFacts(const gpu::Device& device, const Settings& settings, const std::string& command) {
    const DeviceFacts& f = device.facts();
    const char* const threads = std::getenv("LP_NUM_THREADS"); // for Mesa's software device
    const char* kinds[] = {"discrete", "integrated", "cpu", "other"};
    Facts facts{{"command", command},
                {"version", version()},
                {"date", nowInUtc()},
                {"device", f.name},
                {"driver", f.driver},
                {"device_kind", kinds[static_cast<size_t>(f.kind)]},
                {"subgroup", std::to_string(f.subgroupSize)},
                {"timestamps", f.timestampPeriodNs > 0.0 ? "yes" : "no"},
                {"host_cpu", firstMatch("/proc/cpuinfo", "model name")},
                {"host_cpus", std::to_string(usableProcessors())},
                {"LP_NUM_THREADS", threads == nullptr ? "not set" : threads},
                {"load_average", firstMatch("/proc/loadavg", "")},
                {"source", settings.source.empty() ? "analytic scenes" : settings.source.filename().string()},
                {"scene", settings.scene.empty() ? "built in" : settings.scene.filename().string()},
                {"quick", settings.quick ? "yes" : "no"},
                {"build", kBuild}};
    const Facts ofScene = sceneFacts(device, settings);
    facts.insert(facts.end(), ofScene.begin(), ofScene.end());
    return facts;
}

void writeStudyCsv(const Study& study, const std::filesystem::path& file) {
    OutputFile out(file);
    CsvRow row;
    for (const char* name : {"source", "setting", "default", "on_front"}) {
        row.add(std::string_view(name));
    }
    row.add(std::string_view(word(study.errorName + "_" + study.errorUnit)));
    for (const auto& [name, value] : timesOf({})) {
        row.add(std::string_view(name));
    }
    row.add(std::string_view("repeats"));
    for (const std::string& name : study.moreNames) {
        row.add(std::string_view(word(name)));
    }
    row.add(std::string_view("default_judgement"));
    out.write(row.end());
    for (const StudyRow& r : study.rows) {
        row.add(std::string_view(word(r.source)));
        row.add(std::string_view(word(r.setting)));
        row.add(int64_t{r.isDefault});
        row.add(int64_t{r.onFront});
        row.add(r.error);
        for (const auto& [name, value] : timesOf(r.cost)) {
            row.add(value);
        }
        row.add(repeatsOf(r.cost));
        for (double value : r.more) {
            row.add(value);
        }
        row.add(std::string_view(word(judgementOf(study, r))));
        out.write(row.end());
    }
    out.commit();
}

void writeProfileJson(const Facts& facts, const std::vector<Study>& studies, const RunTime& time,
                      const std::filesystem::path& file) {
    Json all;
    all["run_seconds"] = time.wall;
    all["run_cpu_seconds"] = time.cpu;
    for (const auto& [name, value] : facts) {
        all["facts"][name] = value;
    }
    all["studies"] = Json::array();
    for (const Study& study : studies) {
        all["studies"].push_back(studyJson(study));
    }
    OutputFile out(file);
    out.write(all.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
    out.commit();
}

} // namespace fathom::profile
