// SPDX-License-Identifier: Apache-2.0
#include "apps/spheres/spheres_command.h"

#include "apps/number_option.h"
#include "apps/output/try_output.h"
#include "apps/spheres/cover_maker.h"
#include "apps/spheres/spheres_report.h"
#include "engine/model/cover_urdf.h"
#include "engine/model/sph_file.h"
#include "engine/model/sphere_sets.h"
#include "engine/model/write_spheres.h"
#include "engine/model/xml_text.h"
#include "engine/types/error.h"
#include "engine/types/input_files.h"
#include "engine/types/log.h"
#include "engine/types/printable.h"
#include "engine/types/read_file.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <set>

namespace fathom {

namespace {

constexpr size_t kLargestUrdf = 16u << 20;

struct SpheresOptions {
    std::filesystem::path mesh, out, plot, json, meshes;
    CoverOptions cover;
    MeshOptions file;
    std::string up, link;
    bool compare = false;
    std::vector<std::string> given; // given options that need a mesh
};

const std::vector<std::string> kOfMeshes{"--leaves",     "--protrusion", "--up",   "--drop-stray",
                                         "--keep-stray", "--compare",    "--plot", "--json"};

// Before the work.
void checkOutputs(const SpheresOptions& options) {
    std::set<std::filesystem::path> files; // each output needs its own
    std::error_code unknown;
    for (const auto& [name, file] :
         {std::pair("--out", options.out), {"--json", options.json}, {"--plot", options.plot}}) {
        const auto full = std::filesystem::absolute(file, unknown);
        if (!file.empty() && !files.insert(std::filesystem::weakly_canonical(full, unknown)).second) {
            throw BadInput("spheres", name, file.string(), "a file that no other option writes");
        }
    }
    refuseInput(options.out);
    if (!isSphereFile(options.out)) {
        throw BadInput("spheres", "--out", options.out.string(),
                       "a name that ends in .sph, .urdf, .yaml, .yml, .xrdf or .json");
    }
    tryOutput("spheres", "--out", options.out);
    tryOutput("spheres", "--json", options.json);
    tryOutput("spheres", "--plot", options.plot);
}

void drawErrors(const SpheresOptions& options, CoverMaker& maker, size_t leaves) {
    for (uint32_t n = 4; n <= std::min<size_t>(2 * leaves, 1024); n *= 2) {
        CoverOptions at = options.cover;
        at.leaves = n;
        at.protrusion = 0.0;
        maker.ours(at);
        maker.others(n);
    }
    writeErrorPlot(options.plot, options.mesh.filename().string() + ": protrusion against leaf spheres",
                   maker.rows());
}

// Sets of several links.
bool holdsLinks(const std::filesystem::path& file) {
    return isSphereFile(file) && endingOf(file) != ".sph";
}

bool coversUrdf(const SpheresOptions& options) {
    return endingOf(options.mesh) == ".urdf" && holdsLinks(options.out);
}

void checkMeshFolder(const SpheresOptions& options) {
    if (!options.meshes.empty() && !std::filesystem::is_directory(options.meshes)) {
        throw BadInput("spheres", "--meshes", options.meshes.string(), "a folder");
    }
    if (!options.meshes.empty() && !coversUrdf(options)) {
        throw BadInput(options.mesh.string(), "--meshes", "given without shapes of a URDF",
                       "with a .urdf, and --out .urdf, .yaml, .xrdf or .json");
    }
}

void writeSets(const SpheresOptions& options, const std::vector<LinkSpheres>& sets) {
    const std::string kind = endingOf(options.out);
    if (kind == ".xrdf") {
        writeSphereText(options.out, xrdfText(sets));
    } else if (kind == ".json") {
        writeSphereText(options.out, foamText(sets));
    } else if (kind != ".urdf") {
        writeSphereText(options.out, curoboText(sets));
    } else if (endingOf(options.mesh) == ".urdf" && options.link.empty()) {
        writeSphereText(
            options.out,
            spherizedText(readWholeFile(options.mesh, kLargestUrdf, "a readable URDF file"), sets));
    } else if (sets.size() == 1) {
        writeSphereText(options.out, spherizedText(sets[0]));
    } else {
        throw BadInput(options.out.string(), "links", std::to_string(sets.size()),
                       "one, chosen by --link, or the robot's own URDF as input");
    }
    size_t count = 0;
    for (const LinkSpheres& set : sets) {
        count += set.spheres.size();
    }
    std::cout << count << " spheres of " << sets.size() << (sets.size() == 1 ? " link" : " links")
              << " written to " << options.out.string() << std::endl;
}

void convertTree(const SpheresOptions& options) {
    const double scale = options.file.scale.value_or(1.0);
    SphereTree tree = readSphereTree(options.mesh, options.link);
    for (Sphere& s : tree.nodes) {
        s.centre *= scale;
        s.radius *= scale;
    }
    const auto leaves = tree.lastLevel();
    const auto used = std::ranges::count_if(leaves, [](const Sphere& s) { return s.radius >= 0.0; });
    writeSph(tree, options.out);
    std::cout << used << " leaf spheres with recomputed parents written to " << options.out.string()
              << std::endl;
}

// Only the text of a URDF can be copied with other collisions; an MJCF file may have this ending, too.
void refuseOtherText(const SpheresOptions& options) {
    const std::string text = readWholeFile(options.mesh, kLargestUrdf, "a readable URDF file");
    XmlTags tags(text);
    if (tags.next() && tags.tag().name != "robot") {
        throw BadInput(options.mesh.string(), "--out",
                       "a .urdf of <" + excerpt(printable(std::string(tags.tag().name))) + ">",
                       "a .yaml, .xrdf or .json, or --link for a URDF of one link");
    }
}

// From a set of another program, or from all shapes of a URDF.
void convertSets(const SpheresOptions& options) {
    std::vector<LinkSpheres> sets;
    if (endingOf(options.mesh) == ".urdf") {
        if (endingOf(options.out) == ".urdf" && options.link.empty()) {
            refuseOtherText(options);
        }
        const UrdfCover cover =
            coverUrdf(options.mesh, options.meshes, options.cover.leaves, options.file.keepStray);
        for (const std::string& note : cover.notes) {
            log::warn("{}: {}", options.mesh.string(), note);
        }
        sets = selectLink(cover.links, options.link, options.mesh);
    } else {
        sets = readSets(options.mesh, options.link);
    }
    const double scale = options.file.scale.value_or(1.0);
    for (LinkSpheres& set : sets) {
        for (Sphere& s : set.spheres) {
            s.centre *= scale;
            s.radius *= scale;
        }
    }
    writeSets(options, sets);
}

void convert(const SpheresOptions& options) {
    const bool covers = coversUrdf(options);
    const auto wrong = std::ranges::find_if(options.given, [&](const std::string& name) {
        return !covers || (name != "--leaves" && name != "--keep-stray");
    });
    if (wrong != options.given.end()) {
        throw BadInput(options.mesh.string(), *wrong, "given with spheres",
                       "a mesh; of the options only --scale applies to spheres");
    }
    if (covers && options.file.scale) {
        throw BadInput(options.mesh.string(), "--scale", "given with a URDF", "none: a URDF is in metres");
    }
    holdsLinks(options.out) ? convertSets(options) : convertTree(options);
}

Cover coverOf(CoverMaker& maker, const SpheresOptions& options) {
    try {
        return maker.ours(options.cover);
    } catch (const BadInput&) {
        throw;
    } catch (const Error& e) {
        throw BadInput(options.mesh.string(), "--protrusion", e.what(), "a length that fits the mesh");
    }
}

void writeCover(const SpheresOptions& options, const Cover& cover) {
    if (holdsLinks(options.out)) {
        const std::string link = options.link.empty() ? options.mesh.stem().string() : options.link;
        writeSets(options, {{link, cover.spheres}});
    } else {
        writeSph(buildSphereTree(cover.spheres), options.out);
    }
}

void runSpheres(SpheresOptions options) {
    noteInput(options.mesh);
    checkOutputs(options);
    checkMeshFolder(options);
    if (isSphereFile(options.mesh)) {
        convert(options);
        return;
    }
    if (!options.link.empty() && !holdsLinks(options.out)) {
        throw BadInput(options.mesh.string(), "--link", "given with a mesh",
                       "spheres of a .urdf, .yaml, .xrdf or .json");
    }
    options.file.up = options.up.empty() ? '\0' : options.up[0];
    const LoadedMesh loaded = loadMesh(options.mesh, options.file);
    printMesh(std::cout, loaded);
    warnOfMesh(options.mesh, loaded);
    CoverMaker maker(loaded);
    const Cover cover = coverOf(maker, options);
    writeCover(options, cover);
    if (options.compare) {
        maker.others(cover.spheres.size());
    }
    printRows(std::cout, maker.rows());
    if (!options.json.empty()) {
        writeReportJson(options.json, loaded, maker.rows());
    }
    const bool contains = maker.rows()[0].measure.outside == 0;
    if (!options.plot.empty()) {
        maker.takeRows();
        drawErrors(options, maker, cover.spheres.size());
    }
    std::cout << (contains ? "every surface sample is inside a sphere; written to "
                           : "NOT contained; written to ")
              << options.out.string() << std::endl;
    if (!contains) {
        throw Error("the spheres do not contain the mesh"); // impossible by construction
    }
}

void addFileOptions(CLI::App* command, SpheresOptions& options) {
    command->add_option("--leaves", options.cover.leaves, "largest number of leaf spheres (128)")
        ->check(wholeNumberIn(1, kMaxLeaves));
    command
        ->add_option("--protrusion", options.cover.protrusion,
                     "use as few leaves as possible that protrude at most this far [m]")
        ->check(numberIn(Range::zeroOr(1e-6, 10.0)));
    command->add_option("--scale", options.file.scale, "metres per unit of the file (1), also for spheres")
        ->check(numberIn(Range::between(1e-9, 1e6)));
    command->add_option("--up", options.up, "axis of the file that becomes +z (default: unchanged)")
        ->check(wordIn({"x", "y", "z"}));
    command->add_flag(
        "--drop-stray", options.file.dropStray,
        "drop pieces that are far from the rest (default: a mesh with such pieces is rejected)");
    command->add_option("--link", options.link, "link of a .urdf, .yaml, .xrdf or .json");
    command->add_option("--meshes", options.meshes, "folder to use for package:// in a .urdf");
    command->add_flag("--keep-stray", options.file.keepStray, "keep pieces that are far from the rest")
        ->excludes("--drop-stray");
}

} // namespace

void addSpheresCommand(CLI::App& app) {
    auto options = std::make_shared<SpheresOptions>();
    CLI::App* command =
        app.add_subcommand("spheres", "make a sphere tree that contains a mesh, for use as a tool");
    command
        ->add_option("MESH", options->mesh,
                     "STL, OBJ or COLLADA mesh; or spheres: .urdf, .yaml (cuRobo), .xrdf, .json (foam), .sph")
        ->required();
    command
        ->add_option(
            "--out", options->out,
            "sphere tree (.sph), in the mesh's frame [m]; or spheres of links: .urdf, .yaml, .xrdf, .json")
        ->required();
    addFileOptions(command, *options);
    command->add_flag("--compare", options->compare,
                      "compare with the same number of octree and grid spheres");
    command->add_option("--plot", options->plot, "plot (PNG) of protrusion against number of leaves");
    command->add_option("--json", options->json, "write the report as JSON");
    command->callback([options, command] {
        for (const std::string& name : kOfMeshes) {
            if (command->count(name) > 0) {
                options->given.push_back(name);
            }
        }
        runSpheres(*options);
    });
}

} // namespace fathom
