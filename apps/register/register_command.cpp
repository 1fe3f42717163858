// SPDX-License-Identifier: Apache-2.0
#include "apps/register/register_command.h"

#include "apps/binding/open_source.h"
#include "apps/number_option.h"
#include "apps/output/try_output.h"
#include "apps/register/board_finder.h"
#include "apps/register/point_pairs.h"
#include "apps/register/robust_fit.h"
#include "apps/register/tag_finder.h"
#include "engine/types/error.h"
#include "engine/types/input_files.h"
#include "engine/types/log.h"
#include "engine/types/output_file.h"
#include "engine/types/printed.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>

namespace fathom {

namespace {

constexpr uint32_t kFrames = 30;
constexpr size_t kMaxListed = 20;   // outliers
constexpr double kBadCorners = 0.1; // share of corners that a finder may mistake

struct RegisterOptions {
    std::string scene, source, points, tags, board, out;
    std::optional<uint32_t> frames;      // kFrames if not given
    double bound = FitLimits{}.residual; // [m]
};

template <class Finder>
std::vector<PointPair> seenBy(Finder& finder, Camera& camera, const RegisterOptions& options,
                              const std::string& what) {
    std::vector<PointPair> pairs;
    uint32_t frames = 0, with = 0;
    for (; frames < options.frames.value_or(kFrames); ++frames) {
        const std::optional<Frame> frame = camera.next();
        if (!frame) {
            break;
        }
        const std::vector<PointPair> found = finder.find(*frame);
        with += found.empty() ? 0 : 1;
        pairs.insert(pairs.end(), found.begin(), found.end());
    }
    std::cout << "# " << pairs.size() << " corners of " << what << " in " << with << " of " << frames
              << " frames of " << camera.description() << "\n";
    if (pairs.empty()) {
        throw BadInput(camera.description(), what, "none seen", what + " in colour and depth");
    }
    return pairs;
}

std::vector<PointPair> seenTargets(const RegisterOptions& options) {
    const auto camera = openCamera(
        openScene(options.scene),
        options.source.empty() ? std::nullopt : std::optional<std::filesystem::path>(options.source));
    if (!camera->info().hasColour) {
        throw BadInput(camera->description(), "colour", "none", "a camera with colour, or --points");
    }
    if (!options.board.empty()) {
        const BoardPlace place = readBoardPlace(options.board);
        BoardFinder finder(camera->info(), place);
        return seenBy(finder, *camera, options,
                      "the board of " + options.board + " (" + std::to_string(place.columns) + " x " +
                          std::to_string(place.rows) + " inner corners)");
    }
    TagFinder finder(camera->info(), readTagPlaces(options.tags));
    return seenBy(finder, *camera, options, "a tag of " + options.tags);
}

std::string asYaml(const RigidFit& fit) {
    const dvec3& t = fit.baseTcamera.position;
    const dquat& q = fit.baseTcamera.rotation;
    return printed("base_T_camera: {xyz: [%.9g, %.9g, %.9g], quat_xyzw: [%.12g, %.12g, %.12g, %.12g]}\n"
                   "registration_sigma: %.6g\n",
                   t.x, t.y, t.z, q.x, q.y, q.z, q.w, fit.sigma);
}

// The file of points, tags or a board. Throws BadInput for none, for several, and for options that points
// have no use for.
const std::string& inputOf(const RegisterOptions& options) {
    const std::string* from = nullptr;
    int given = 0;
    for (const std::string* file : {&options.points, &options.tags, &options.board}) {
        given += file->empty() ? 0 : 1;
        from = file->empty() ? from : file;
    }
    if (given != 1) {
        throw BadInput("register", "--points, --tags, --board", given == 0 ? "none" : "several",
                       "one of them");
    }
    if (from == &options.points && (!options.source.empty() || options.frames)) {
        throw BadInput("register", options.frames ? "--frames" : "--source", "given with --points",
                       "only with --tags or --board: points need no camera");
    }
    return *from;
}

void runRegister(const RegisterOptions& options) {
    const std::string& from = inputOf(options);
    noteInput(options.scene); // points need no scene, but the lines are often meant for it
    noteInput(from);
    tryOutput("register", "--out", options.out);
    const bool fromPoints = &from == &options.points;
    const std::vector<PointPair> pairs = fromPoints ? readPointPairs(options.points) : seenTargets(options);
    const RobustFit robust = fitRobust(pairs, {options.bound, fromPoints ? 0.0 : kBadCorners}, from);
    const RigidFit& fit = robust.fit;
    const std::string yaml = asYaml(fit);
    std::cout << "# used " << pairs.size() - robust.outliers.size() << " of " << pairs.size()
              << " pairs; standard deviation " << 1e3 * fit.sigma << " mm, largest distance "
              << 1e3 * fit.worst << " mm (" << fit.worstName << ")\n";
    for (size_t i = 0; i < std::min(robust.outliers.size(), kMaxListed); ++i) {
        const RobustFit::Outlier& outlier = robust.outliers[i];
        std::cout << "# rejected: " << outlier.name << ", " << 1e3 * outlier.distance << " mm away\n";
    }
    if (!robust.rejection.empty()) {
        throw Error(from + ": rejected: " + robust.rejection);
    }
    if (fromPoints && robust.flat) {
        log::warn("{}: all points are coplanar, within their scatter: a negated axis would not be noticed; "
                  "touch a point off the plane",
                  from);
    }
    std::cout << "# for the camera section of the scene; every region grows by 3 registration_sigma\n"
              << yaml;
    if (!options.out.empty()) {
        OutputFile file(options.out);
        file.write(yaml);
        file.commit();
    }
}

} // namespace

void addRegisterCommand(CLI::App& app, const GlobalOptions&) {
    auto options = std::make_shared<RegisterOptions>();
    CLI::App* command = app.add_subcommand("register", "find base_T_camera and its uncertainty");
    command->add_option("SCENE", options->scene, "scene file (YAML)")->required();
    command->add_option("--source", options->source, kSourceHelp);
    command->add_option("--tags", options->tags,
                        "AprilTags 36h11 in the base frame: CSV id,size_m,x,y,z,qx,qy,qz,qw; the pose of the "
                        "middle: x right, y down, z into the print");
    command->add_option(
        "--board", options->board,
        "a chessboard in the base frame: CSV columns,rows,square_m,x,y,z,qx,qy,qz,qw; counts inner corners");
    command->add_option(
        "--points", options->points,
        "the same points in both frames: CSV camera_x,camera_y,camera_z,base_x,base_y,base_z [m]");
    command->add_option("--frames", options->frames, "number of frames to use (30)")
        ->check(wholeNumberIn(1, 10000));
    command
        ->add_option("--bound", options->bound,
                     "[m] largest standard deviation of the pairs (0.02); beyond it, the exit code is 1")
        ->check(numberIn(Range::between(1e-4, 1.0)));
    command->add_option("--out", options->out, "write the two lines of YAML to this file");
    command->callback([options] { runRegister(*options); });
}

} // namespace fathom
