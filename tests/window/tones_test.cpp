// SPDX-License-Identifier: Apache-2.0
// Tones of the window, heard through a file in place of a sound card.
#include "tests/window/window_rig.h"

#include <algorithm>
#include <cstdlib>
#include <dlfcn.h>
#include <doctest/doctest.h>
#include <fstream>
#include <iterator>

using namespace fathom;
using namespace fathom::window;
using nlohmann::json;

namespace {

// ALSA's configuration for programs that start while this exists.
class SoundCard {
public:
    explicit SoundCard(const std::string& settings) {
        folder_.write("asound.conf", "pcm.null { type null }\n" + settings);
        ::setenv("ALSA_CONFIG_PATH", (folder_.path() / "asound.conf").c_str(), 1);
    }
    ~SoundCard() { ::unsetenv("ALSA_CONFIG_PATH"); }
    SoundCard(const SoundCard&) = delete;
    SoundCard& operator=(const SoundCard&) = delete;

private:
    TemporaryFolder folder_;
};

// What was played since the device was opened last.
std::vector<int16_t> played(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(in), {}};
    std::vector<int16_t> samples(bytes.size() / sizeof(int16_t));
    std::copy_n(bytes.begin(), samples.size() * sizeof(int16_t), reinterpret_cast<char*>(samples.data()));
    return samples;
}

// Periods of the sound wave.
int periods(const std::vector<int16_t>& samples) {
    int count = 0;
    for (size_t i = 1; i < samples.size(); ++i) {
        count += samples[i - 1] < 0 && samples[i] >= 0 ? 1 : 0;
    }
    return count;
}

void armForces(WindowRig& rig) {
    rig.key("a");
    REQUIRE(rig.await([](const json& s) { return s["console"]["forces"] == true; }));
}

// Leaves the region for more than a second and touches it again, until one more tone is due. On a busy
// machine it may be another one, for an old image.
void touchAgain(WindowRig& rig) {
    const auto before = rig.state()["console"]["tone_count"].get<int>();
    const auto more = [before](const json& s) { return s["console"]["tone_count"] > before; };
    for (int i = 0; i < 40 && rig.state()["run"]["contacts"] > 0; ++i) {
        rig.wheel(-2);
    }
    const auto ticks = rig.state()["run"]["turns"].get<int>();
    REQUIRE(rig.await([&](const json& s) { return s["run"]["turns"] > ticks + 1200; }));
    for (int i = 0; i < 40 && !more(rig.state()); ++i) {
        rig.wheel(2);
    }
    REQUIRE(rig.await(more));
}

// Periods of the sound wave of a tone.
int periodsOf(const std::string& tone) {
    return tone == "contact" ? 61 : tone == "limit" ? 105 : tone == "stale" ? 117 : 397;
}

size_t count(const std::string& text, const std::string& words) {
    size_t n = 0;
    for (size_t at = text.find(words); at != std::string::npos; at = text.find(words, at + 1)) {
        ++n;
    }
    return n;
}

} // namespace

TEST_CASE("A first contact is heard, M turns tones off, and the scene keeps that") {
    if (::dlopen("libasound.so.2", RTLD_NOW) == nullptr) {
        MESSAGE("SKIPPED: libasound.so.2 is not installed");
        return;
    }
    const TemporaryFolder folder;
    const auto file = folder.path() / "tones.raw";
    const SoundCard card("pcm.!default { type file slave.pcm \"null\" file \"" + file.string() +
                         "\" format \"raw\" }\n");
    WindowRig rig;
    armForces(rig);
    rig.push();
    CHECK(rig.await([&](const json& s) {
        const std::string last = s["console"]["last_tone"];
        return !last.empty() && std::abs(periods(played(file)) - periodsOf(last)) <= 4;
    }));
    rig.key("m");
    REQUIRE(rig.await([](const json& s) { return s["console"]["tones"] == false; }));
    const auto ticks = rig.state()["run"]["turns"].get<int>();
    REQUIRE(
        rig.await([&](const json& s) { return s["run"]["turns"] > ticks + 2000; })); // a tone that plays ends
    const auto before = std::filesystem::last_write_time(file);
    touchAgain(rig);
    CHECK(std::filesystem::last_write_time(file) == before);
    rig.key("ctrl+s");
    REQUIRE(rig.awaitNotice("fixtures saved"));
    CHECK(rig.sceneText().find("tones: false") != std::string::npos);
    rig.reopen(rig.folder() / "scene.yaml");
    CHECK(rig.state()["console"]["tones"] == false);
    closeQuietly(rig);
}

TEST_CASE("Without a sound card there is one line, and everything else works") {
    const SoundCard none("");
    WindowRig rig;
    armForces(rig);
    rig.push();
    REQUIRE(rig.await([](const json& s) { return s["console"]["tone_count"] > 0; }));
    touchAgain(rig);
    CHECK(rig.close() == 0);
    CHECK(count(rig.output(), "tones are silent") == 1);
    CHECK(rig.output().find("ALSA lib") == std::string::npos);
}
