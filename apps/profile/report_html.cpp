// SPDX-License-Identifier: Apache-2.0
#include "apps/profile/report.h"
#include "engine/types/error.h"
#include "engine/types/output_file.h"

#include <fstream>
#include <iterator>

namespace fathom::profile {

namespace {

constexpr const char* kStyle =
    "<style>body{font:15px/1.5 system-ui,sans-serif;color:#21262d;background:#fdfdfc;max-width:1600px;"
    "margin:2em auto;padding:0 1.5em}h1{margin-bottom:0}h2{margin-top:2.2em;border-top:2px solid #d8dade;"
    "padding-top:.8em}img{max-width:100%;border:1px solid #e3e5e8}table{border-collapse:collapse;"
    "font-variant-numeric:tabular-nums;font-size:13px}th{text-align:left;background:#f0f1f3;position:sticky;"
    "top:0}th,td{padding:.25em .7em;border-bottom:1px solid #e3e5e8}td.n{text-align:right}tr.d{font-weight:"
    "600;background:#fff6d9}tr.f td:first-child{border-left:4px solid #0072b2}details{margin:1em 0}"
    "summary{cursor:pointer}.why{color:#5a626c}</style>";

std::string escaped(const std::string& text) {
    std::string out;
    for (char c : text) {
        out += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
    }
    return out;
}

std::string base64Of(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    if (bytes.empty()) {
        throw Error(file.string() + ": cannot be read for the report");
    }
    constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    out.reserve(bytes.size() / 3 * 4 + 4);
    for (size_t i = 0; i < bytes.size(); i += 3) {
        uint32_t word = 0;
        for (size_t k = 0; k < 3; ++k) {
            word = word << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        }
        for (size_t k = 0; k < 4; ++k) {
            out += i + k <= bytes.size() ? kDigits[word >> (18 - 6 * k) & 63u] : '=';
        }
    }
    return out;
}

std::string cell(double value) {
    return "<td class=n>" + (std::isfinite(value) ? digits(value, 4) : std::string("–")) + "</td>";
}

std::string cells(const Spread& s) {
    const double none = std::numeric_limits<double>::quiet_NaN();
    return cell(s ? s.p50 : none) + cell(s ? s.p90 : none) + cell(s ? s.p99 : none);
}

std::string tableOf(const Study& study) {
    std::string html = "<details><summary>all " + std::to_string(study.rows.size()) +
                       " rows (blue edge: Pareto front; yellow: default; times in ms)</summary><table><tr>"
                       "<th>source<th>setting<th>" +
                       escaped(study.errorName + " [" + study.errorUnit + "]");
    for (const char* clock : {"GPU", "submit to result", "CPU", "wall"}) {
        for (const char* rank : {"p50", "p90", "p99"}) {
            html += std::string("<th>") + clock + " " + rank;
        }
    }
    for (const std::string& name : study.moreNames) {
        html += "<th>" + escaped(name);
    }
    html += "</tr>\n";
    for (const StudyRow& row : study.rows) {
        html += std::string("<tr class=\"") + (row.isDefault ? "d " : "") + (row.onFront ? "f" : "") +
                "\"><td>" + escaped(row.source) + "</td><td>" + escaped(row.setting) + "</td>" +
                cell(row.error) + cells(row.cost.gpu) + cells(row.cost.submit) + cells(row.cost.cpu) +
                cells(row.cost.wall);
        for (double value : row.more) {
            html += cell(value);
        }
        html += "</tr>\n";
    }
    return html + "</table></details>\n";
}

// The verdicts on the default settings, or the reason why there are none.
std::string defaultsOf(const Study& study) {
    if (study.verdicts.empty()) {
        return "<p>No default to judge: " + escaped(study.noDefault) + "</p>\n";
    }
    std::string html = "<table><tr><th>default<th>on<th>on the Pareto front<th>why</tr>\n";
    for (const Verdict& v : study.verdicts) {
        html += std::string("<tr") + (v.onFront ? "" : " class=d") + "><td>" + escaped(v.setting) + "<td>" +
                escaped(v.source) + "<td>" + (v.onFront ? "yes" : "no") + "<td>" + escaped(v.words) +
                "</tr>\n";
    }
    return html + "</table>\n";
}

std::string sectionOf(const Study& study, const std::filesystem::path& folder) {
    std::string html = "<h2 id=" + study.name + ">" + escaped(study.title) +
                       "</h2>\n<p class=why>verified before timing: " + escaped(study.verified) +
                       "<br>measured: " + escaped(study.served) + "</p>\n<img alt=\"" + escaped(study.title) +
                       "\" src=\"data:image/png;base64," + base64Of(folder / (study.name + ".png")) +
                       "\">\n<ul>";
    for (const std::string& finding : study.findings) {
        html += "<li>" + escaped(finding) + "</li>\n";
    }
    return html + "</ul>\n" + defaultsOf(study) + tableOf(study);
}

} // namespace

void writeReportHtml(const Facts& facts, const std::vector<Study>& studies,
                     const std::filesystem::path& folder) {
    OutputFile out(folder / "report.html");
    out.write(
        "<!doctype html><html lang=en><meta charset=utf-8><title>fathom profile</title>" +
        std::string(kStyle) +
        "<h1>Error against run time</h1>\n<p class=why>Each clock has its own columns, and none is "
        "subtracted from another: device timestamps, submission until the result is known to the host, CPU "
        "time of the calling thread, and wall time for steps with none of these. p50, p90, p99 by nearest "
        "rank; p99 needs 100 repeats.</p>"
        "<table>");
    for (const auto& [name, value] : facts) {
        out.write("<tr><td>" + escaped(name) + "</td><td>" + escaped(value) + "</td></tr>\n");
    }
    out.write("</table>\n<p>");
    for (const Study& study : studies) {
        out.write("<a href=\"#" + study.name + "\">" + study.name + "</a> ");
    }
    out.write("</p>\n");
    for (const Study& study : studies) {
        out.write(sectionOf(study, folder));
    }
    out.write("</html>\n");
    out.commit();
}

} // namespace fathom::profile
