// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/open_card.h"

#include "apps/operate/keys.h"
#include "apps/operate/theme.h"
#include "engine/types/error.h"

#include <GLFW/glfw3.h>
#include <algorithm>
#include <utility>

namespace fathom::operate {

namespace fs = std::filesystem;

namespace {

constexpr size_t kMaxShown = 200, kMaxEntries = 100'000, kMaxCardCharacters = 36;

bool isRecording(const fs::path& folder) {
    std::error_code no;
    return fs::exists(folder / "scene.yaml", no) &&
           (fs::exists(folder / "associations.txt", no) || fs::exists(folder / "depth.txt", no));
}

void ask(Console& console, const fs::path& in, bool mayGoLive) {
    OpenCard& card = console.openCard;
    try {
        card.choices = recordingsIn(in);
    } catch (const Error& e) {
        console.notify(e.what());
        card.choices.clear();
        if (!mayGoLive) {
            return;
        }
    }
    if (mayGoLive) {
        card.choices.insert(card.choices.begin(), kLiveRun);
    }
    if (card.choices.empty()) {
        console.notify("no recording in " + fs::absolute(in).string());
        return;
    }
    card.chosen = 0;
    card.on = true;
    console.stopAiming(); // Enter opens
}

void open(Console& console) {
    OpenCard& card = console.openCard;
    card.next = card.choices.at(card.chosen);
    card.on = false;
    card.leaves = true;
}

} // namespace

std::vector<std::string> recordingsIn(const fs::path& in) {
    std::vector<std::pair<fs::file_time_type, std::string>> found;
    std::error_code failed;
    fs::directory_iterator entries(in.empty() ? fs::path(".") : in, failed);
    for (size_t n = 0; !failed && entries != fs::directory_iterator() && n < kMaxEntries; ++n) {
        if (isRecording(entries->path())) {
            std::error_code unknown;
            found.emplace_back(fs::last_write_time(entries->path(), unknown), entries->path().string());
        }
        entries.increment(failed);
    }
    if (failed) {
        throw Error((in.empty() ? fs::path(".") : in).string() + ": cannot be read (" + failed.message() +
                    ")");
    }
    std::sort(found.rbegin(), found.rend());
    found.resize(std::min(found.size(), kMaxShown));
    std::vector<std::string> names;
    for (auto& [time, name] : found) {
        names.push_back(std::move(name));
    }
    return names;
}

void stepOpenCard(Console& console, const fs::path& in, bool mayGoLive) {
    OpenCard& card = console.openCard;
    const bool pressed = std::exchange(console.requests.openCard, false);
    if (!card.on) {
        if (pressed && console.closing.stage == ClosingStage::No) {
            ask(console, in, mayGoLive);
        }
        return;
    }
    card.chosen = pressed ? (card.chosen + 1) % card.choices.size() : card.chosen;
    if (keyPressed(GLFW_KEY_ESCAPE) || console.closing.stage != ClosingStage::No) {
        card.on = false;
    } else if (keyPressed(GLFW_KEY_ENTER) || std::exchange(card.clicked, false)) {
        open(console);
    }
}

std::string opensNext(const Console& console, bool stopped) {
    return console.closing.quit && !stopped ? console.openCard.next : "";
}

void drawOpenCard(Console& console, ImVec2 corner, ImVec2 size) {
    OpenCard& card = console.openCard;
    if (!card.on) {
        return;
    }
    const float line = ImGui::GetTextLineHeightWithSpacing(), width = std::min(0.9f * size.x, 34.0f * line);
    ImGui::SetNextWindowPos({corner.x + 0.5f * size.x, corner.y + 0.5f * size.y}, ImGuiCond_Always,
                            {0.5f, 0.5f});
    const float rows = std::min(static_cast<float>(card.choices.size()) + 3.0f, 0.8f * size.y / line);
    ImGui::SetNextWindowSize({width, rows * line + 1.5f * line});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 2.0f);
    ImGui::PushStyleColor(ImGuiCol_Border, colour::kPicked);
    if (ImGui::Begin("open", nullptr,
                     ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                         ImGuiWindowFlags_NoSavedSettings)) {
        ImGui::PushTextWrapPos(0.0f);
        ImGui::TextUnformatted("Open a recording.  O: next  Enter: open  Esc: stay.  Forces go off.");
        ImGui::PopTextWrapPos();
        ImGui::BeginChild("recordings");
        for (size_t i = 0; i < card.choices.size(); ++i) {
            const fs::path path(card.choices[i]);
            const std::string name = (path.has_filename() ? path.filename() : path).string();
            const std::string shown =
                name.size() <= kMaxCardCharacters ? name : name.substr(0, kMaxCardCharacters) + "...";
            if (ImGui::Selectable((shown + "##" + std::to_string(i)).c_str(), card.chosen == i)) {
                card.chosen = i;
                card.clicked = true;
            }
            markPlace(console, "open " + name);
            explain(console, "Enter or a click: forces off, then this is shown in place of this window");
            if (card.chosen == i) {
                ImGui::SetScrollHereY();
            }
        }
        ImGui::EndChild();
    }
    ImGui::End();
    ImGui::PopStyleColor();
    ImGui::PopStyleVar();
}

} // namespace fathom::operate
