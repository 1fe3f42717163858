// SPDX-License-Identifier: Apache-2.0
// Growth of a frame's cost with image size, fraction of selected pixels and number of classes. The wall has
// sensor noise, because without it thinning keeps fewer points and later passes do less work. Colours are
// YUYV, as from USB cameras, except in rows that name a format.
#include "apps/profile/frame_sequence.h"
#include "apps/profile/studies.h"
#include "engine/types/number_text.h"

#include <algorithm>

namespace fathom::profile {

namespace {

// Number of patches compared with the float64 twin: all of them up to 320x240, a sample in larger images.
constexpr size_t kTwinPatches = 300;

// The quantity that a row varies. Each has its own column; the others do not apply.
enum class Grows { Pixels, SharePercent, Classes };

struct ScaledCost {
    double x = 0.0;
    FrameCost cost;
};

using Curve = std::vector<ScaledCost>;

// where: who answers contact queries. Only the frame is measured; the `query` study measures queries.
Scene sceneWith(const Settings& settings, uint32_t classes, Scene::Contact::Where where) {
    Settings plain = settings;
    plain.source.clear();
    Scene scene = studyScene(plain);
    scene.contact.where = where;
    for (uint32_t c = 2; c < classes; ++c) { // extra hues that do not occur in the image
        FixtureClass f = scene.fixtures.front();
        f.name = "class " + std::to_string(c + 1);
        f.role = c % 2 == 0 ? Role::Forbidden : Role::Guidance;
        f.hue = Band{80.0 + 30.0 * c, 100.0 + 30.0 * c};
        scene.fixtures.push_back(f);
    }
    scene.fixtures.resize(std::min<size_t>(scene.fixtures.size(), classes));
    return scene;
}

class ScalingRun {
public:
    ScalingRun(const StudyContext& context, Study& study)
        : context_(context)
        , study_(study) {}

    ScaledCost take(const std::string& source, const std::string& setting, Grows by, double x,
                    const FrameSequence& frames, uint32_t classes,
                    Scene::Contact::Where where = Scene::Contact::Where::Cpu) {
        FrameBench bench(context_.device, sceneWith(context_.settings, classes, where), frames.camera);
        const uint32_t guided = bench.run(frames.frames.front()).guidanceCount;
        check(bench, setting, frames);
        ScaledCost m{x, bench.measure(frames.frames, context_.settings.repeats())};
        if (guided == 0) { // empty dispatch
            m.cost.passes.erase("moments");
        }
        addRow(source, setting, by, m, bench, NAN);
        return m;
    }

    // One row per format of colour, measured in alternation, with the time that the host would unpack it.
    void takeFormats(const std::vector<ColourFormat>& formats, const FrameSequence& plain) {
        std::vector<FrameSequence> sent;
        std::vector<std::unique_ptr<FrameBench>> benches;
        std::vector<FrameSamples> samples(formats.size());
        std::vector<CpuSamples> unpacking(formats.size());
        for (const ColourFormat format : formats) {
            sent.push_back(sentAs(format, plain));
            benches.push_back(std::make_unique<FrameBench>(
                context_.device, sceneWith(context_.settings, 2, Scene::Contact::Where::Cpu),
                sent.back().camera));
            benches.back()->run(sent.back().frames.front());
            check(*benches.back(), plain.name, sent.back());
        }
        constexpr size_t kRounds = 5;
        const Repeats all = context_.settings.repeats(),
                      part{(all.least + kRounds - 1) / kRounds, all.most, all.seconds / kRounds};
        for (size_t i = 0; i < kRounds * formats.size(); ++i) {
            const size_t k = i % formats.size();
            SampleFrame image = sent[k].frames.front();
            benches[k]->sample(sent[k].frames, part, samples[k]);
            repeat(
                part, [&] { unpackColour(image.packed.image(), image.colour); },
                [&](const Clocks& clocks) { unpacking[k].take(clocks); });
        }
        for (size_t k = 0; k < formats.size(); ++k) {
            const double x = plain.camera.depth.pixels();
            addRow("size, every point forbidden, colours " + std::string(nameOf(formats[k])), plain.name,
                   Grows::Pixels, {x, benches[k]->costOf(samples[k])}, *benches[k],
                   formats[k] == ColourFormat::Rgba ? 0.0 : unpacking[k].cost().cpu.p50);
        }
    }

    // unpackMs: on the host, of this format of colour; NaN = not measured.
    void addRow(const std::string& source, const std::string& setting, Grows by, const ScaledCost& m,
                const FrameBench& bench, double unpackMs) {
        const double x = m.x;
        StudyRow row;
        row.source = source;
        row.setting = setting;
        row.isDefault = false;
        row.cost = m.cost.frame;
        row.more = {by == Grows::Pixels ? x : NAN,
                    by == Grows::SharePercent ? x : NAN,
                    by == Grows::Classes ? x : NAN,
                    m.cost.total.p50,
                    m.cost.collected.p50,
                    m.cost.upload.p50,
                    m.cost.collect.p50,
                    m.cost.grid.p50,
                    static_cast<double>(bench.set().host.spheres.size())};
        for (const char* pass : {"classify", "list", "surface", "thin", "spheres", "moments"}) {
            const auto it = m.cost.passes.find(pass);
            row.more.push_back(it != m.cost.passes.end() ? it->second.p50 : NAN);
        }
        row.more.push_back(m.cost.answerable.p50);
        row.more.push_back(unpackMs);
        study_.rows.push_back(std::move(row));
    }

    // Draws one line per step of the frame and adds its exponent.
    void draw(const Curve& curve, const std::string& title, const std::string& xLabel, bool logarithmic) {
        PlotPanel panel;
        panel.title = title;
        panel.xLabel = xLabel;
        panel.yLabel = "time p50 [ms]";
        panel.logX = logarithmic;
        const auto add = [&](const std::string& name, auto&& value) {
            PlotSeries series{name, {}, true, 0.0, name};
            for (const ScaledCost& m : curve) {
                const Spread spread = value(m);
                series.points.push_back({m.x, spread.p50, "", false, false, NAN, spread ? spread.p90 : NAN});
            }
            const auto law = fitPower(series.points);
            if (law) {
                series.name += " ~ x^" + digits(law->exponent, 2);
                study_.findings.push_back(title + ": " + name + " grows as x^" + digits(law->exponent, 3));
            }
            panel.series.push_back(std::move(series));
        };
        add("upload to published", [](const ScaledCost& m) { return m.cost.total; });
        add("upload (host)", [](const ScaledCost& m) { return m.cost.upload; });
        add("collect (host)", [](const ScaledCost& m) { return m.cost.collect; });
        add("grid (host)", [](const ScaledCost& m) { return m.cost.grid; });
        for (const auto& [name, spread] : curve.front().cost.passes) {
            add(name, [pass = name](const ScaledCost& m) { // without guidance, no moments
                const auto it = m.cost.passes.find(pass);
                return it != m.cost.passes.end() ? it->second : Spread{};
            });
        }
        study_.panels.push_back(std::move(panel));
    }

private:
    // Verifies each size before timing it.
    static void check(FrameBench& bench, const std::string& setting, const FrameSequence& frames) {
        const std::string wrong = bench.differsFromTwins(frames.frames.front(), kTwinPatches);
        verify(wrong.empty(), "scaling", setting, wrong + " differs from the float64 twin");
        const std::string sphere = bench.spheresDiffer();
        verify(sphere.empty(), "scaling", setting, sphere + " is not around its own forbidden point");
        const FrameReport report = bench.run(frames.frames.front());
        verify(report.counts.valid == frames.camera.depth.pixels(), "scaling", setting,
               "valid pixels are missing");
    }

    const StudyContext& context_;
    Study& study_;
};

using Sizes = std::vector<std::pair<uint32_t, uint32_t>>;

Curve sizesOf(ScalingRun& run, WallNoise noise, bool quick) {
    Curve sizes;
    for (const auto& [w, h] :
         quick ? Sizes{{80, 60}, {160, 120}, {400, 300}}
               : Sizes{{160, 120}, {320, 240}, {640, 480}, {1280, 720}, {1920, 1080}, {3840, 2160}}) {
        const FrameSequence frames = inYuyv(wallFrame(w, h, 1.0, noise));
        const char* source = noise == WallNoise::Sensor ? "size, every point forbidden"
                                                        : "size, every point forbidden, noise-free";
        sizes.push_back(run.take(source, frames.name, Grows::Pixels, w * static_cast<double>(h), frames, 2));
    }
    return sizes;
}

// Cost of each format in which cameras and recordings send colours.
void formatsOfColour(ScalingRun& run, bool quick) {
    for (const auto& [w, h] : quick ? Sizes{{160, 120}} : Sizes{{640, 480}, {1280, 720}, {3840, 2160}}) {
        run.takeFormats({ColourFormat::Rgba, ColourFormat::Rgb, ColourFormat::Bgr, ColourFormat::Yuyv,
                         ColourFormat::Uyvy, ColourFormat::Planes, ColourFormat::JpegPlanes},
                        wallFrame(w, h, 1.0, WallNoise::Sensor));
    }
}

// Where the device answers contact queries, it answers before the host has its copy of a set.
void answeredByDevice(ScalingRun& run, bool quick) {
    for (const auto& [w, h] : quick ? Sizes{{160, 120}} : Sizes{{640, 480}, {1280, 720}, {3840, 2160}}) {
        for (const double share : {0.1, 1.0}) {
            const FrameSequence frames = inYuyv(wallFrame(w, h, share, WallNoise::Sensor));
            run.take("size, " + digits(share * 100.0) + " % forbidden, GPU answers contacts", frames.name,
                     Grows::Pixels, w * static_cast<double>(h), frames, 2, Scene::Contact::Where::Gpu);
        }
    }
}

Curve sharesOf(ScalingRun& run, uint32_t w, uint32_t h, bool quick) {
    Curve shares;
    for (double share : quick ? std::vector{0.0, 0.5, 1.0} : std::vector{0.0, 0.1, 0.25, 0.5, 0.75, 1.0}) {
        shares.push_back(run.take("forbidden share of " + sizeText(w, h), digits(share * 100.0) + " %",
                                  Grows::SharePercent, share * 100.0,
                                  inYuyv(wallFrame(w, h, share, WallNoise::Sensor)), 2));
    }
    return shares;
}

Curve classesOf(ScalingRun& run, uint32_t w, uint32_t h, bool quick) {
    Curve classes;
    for (uint32_t c : quick ? std::vector<uint32_t>{1, 8} : std::vector<uint32_t>{1, 2, 3, 4, 6, 8}) {
        classes.push_back(run.take("classes, 10 % forbidden", std::to_string(c) + " classes", Grows::Classes,
                                   c, inYuyv(wallFrame(w, h, 0.1, WallNoise::Sensor)), c));
    }
    return Curve(classes.rbegin(), classes.rend()); // largest first: its passes name the lines
}

const std::vector<std::string> kColumns = {"pixels",
                                           "forbidden_percent",
                                           "classes",
                                           "upload_to_published_p50_ms",
                                           "upload_to_collected_p50_ms",
                                           "upload_p50_ms",
                                           "collect_p50_ms",
                                           "grid_p50_ms",
                                           "spheres",
                                           "classify_p50_ms",
                                           "list_p50_ms",
                                           "surface_p50_ms",
                                           "thin_p50_ms",
                                           "spheres_p50_ms",
                                           "moments_p50_ms",
                                           "upload_to_answerable_p50_ms",
                                           "unpack_on_host_p50_ms"};

} // namespace

Study scalingStudy(const StudyContext& context) {
    Study study;
    study.name = "scaling";
    study.title = "Scaling: frame size, selected pixels, classes";
    study.verified =
        "at every size: class bits of every pixel and points of up to 300 patches, corners included, against "
        "the float64 twins; every region sphere is around its own forbidden point; every pixel is counted";
    study.findings.push_back("colours are YUYV, as USB cameras send them, unless a row names a format; "
                             "planes of YUV are NV12, those "
                             "of JPEG 4:2:2");
    study.findings.push_back("where the GPU answers contacts, the grid is built only to measure it");
    study.noDefault = "its rows are sizes and scenes, which camera and scene file determine";
    study.timeName = "upload to published p50";
    study.moreNames = kColumns;
    const bool quick = context.settings.quick;
    const uint32_t w = quick ? 160 : 640, h = quick ? 120 : 480;
    const std::string size = sizeText(w, h);
    ScalingRun run(context, study);
    const Curve sizes = sizesOf(run, WallNoise::Sensor, quick), smooth = sizesOf(run, WallNoise::None, quick),
                shares = sharesOf(run, w, h, quick), classes = classesOf(run, w, h, quick);
    formatsOfColour(run, quick);
    answeredByDevice(run, quick);
    run.draw(sizes, "every point forbidden", "pixels", true);
    run.draw(smooth, "every point forbidden, noise-free", "pixels", true);
    run.draw(shares, size + ", forbidden share", "forbidden pixels [%]", false);
    run.draw(classes, size + ", 10 % forbidden, by classes", "classes of points", false);
    return study;
}

} // namespace fathom::profile
