// SPDX-License-Identifier: Apache-2.0
// The scene file as checked, plain values. loadScene() fills it; it is constant afterwards.
#pragma once

#include "engine/types/camera_info.h"
#include "engine/types/flat_port.h"
#include "engine/types/haptic_device.h"
#include "engine/types/pose.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace fathom {

// Inclusive band. For hue lo > hi wraps through 0.
struct Band {
    double lo = 0.0, hi = 0.0;
};

struct Box { // base frame [m], inclusive
    dvec3 min{0.0}, max{0.0};
};

// Role of a fixture: push the tool back, or pull it to a target.
enum class Role { Forbidden, Guidance };

// Kinds of placed shapes; None: a class of points.
enum class ShapeKind { None, Sphere, Box, Plane, Cylinder, Line, Axis };

// One fixture: a class of points (shape None) or a placed shape.
struct FixtureClass {
    std::string name;
    Role role = Role::Forbidden;
    // Points: gates that select pixels. A missing gate accepts everything.
    std::optional<Band> hue;        // [degree] 0..360; a grey pixel has none and fails this gate
    std::optional<Band> saturation; // 0..1
    std::optional<Band> lightness;  // 0..1
    std::optional<Box> box;
    std::optional<Band> range; // [m] from the camera to the point
    // [m] radius of the sphere at each forbidden point; 3 sigma of the registration are added
    double radius = 0.04;
    // Guidance.
    double standoff = 0.0;                 // [m] target = position + standoff x normal
    dquat orientation{1.0, 0.0, 0.0, 0.0}; // base_q_tool when the points are not planar
    uint32_t minCount = 50;                // fewer points: no target
    bool largestPart = false;              // only the largest connected part of the class
    double trim = 0.0;                     // fraction of the farthest points excluded from the mean, 0..0.5
    // Shapes.
    ShapeKind shape = ShapeKind::None;
    bool keepIn = false; // role keep_in: stay inside the shape
    // Points: frozen at their positions at the time this was set, until the run ends (not a scene key).
    bool frozen = false;
    Pose baseTshape;
    dvec3 size{0.0}; // [m] box: edge lengths; sphere: x = radius; cylinder: x = radius, y = length

    bool usesColour() const { return hue || saturation || lightness; }
    bool isPoints() const { return shape == ShapeKind::None; }
    // A hard constraint of the tool's pose, whatever the role.
    bool isEquality() const { return shape == ShapeKind::Line || shape == ShapeKind::Axis; }
};

// Source of the frames.
struct CameraSource {
    enum class Kind { Simulated, Recorded, V4l2, Ros2 } kind = Kind::Simulated;
    std::string value = "tank"; // simulated: scene name; recorded: folder; v4l2: device; ros2: topics
    uint32_t images = 240;      // frames of a simulated camera
    bool showsArm = false;      // a simulated camera draws the scene's arm, in lockstep
    bool yuyv = false;          // a simulated camera delivers colour as YUYV, like USB cameras
};

// The simulated hand that closes the loop (--hand).
struct HandLoop {
    double mass = 0.2;        // [kg]
    double damping = 1.0;     // [N s/m]
    double stiffness = 300.0; // [N/m] of the spring to the intended path
};

// Section `arm:` as written; joint and link names are resolved when the URDF is read.
struct SceneArm {
    std::filesystem::path urdf, meshes;   // meshes: root of package:// paths; empty = near the URDF
    Pose baseTarm;                        // of the arm's base link
    std::string base, tip;                // links; empty = chosen by the tree
    std::map<std::string, double> locked; // joints that stay at this value [rad], [m]
    bool keepStray = false;               // keep pieces of meshes that lie far from the rest
    uint32_t leaves = 24;                 // of each box, cylinder or mesh of the URDF
    // Overrides of the URDF.
    struct Joint {
        std::string name;
        std::optional<double> lower, upper; // [rad], [m]
        std::optional<double> speed;        // [rad/s], [m/s]
        std::optional<double> start;        // [rad], [m]; else 0, or the nearest limit
    };
    std::vector<Joint> joints;
    // the hand's orientation is ignored: too few joints, or a device without orientation
    bool freeDirection = false;
    std::optional<double> selfFilter; // [m] padding of the links' spheres; empty = no self-filter
    // A gripper joint.
    struct Finger {
        std::string joint;
        std::optional<double> open, closed; // [rad], [m]; else the URDF's lower and upper limit
    };
    // How the gripper closes.
    struct Grasp {
        std::vector<Finger> fingers;
        uint32_t button = 8;  // bit of the hand's buttons: closes while it is down
        double seconds = 1.0; // from open to closed
    } grasp;
    // The real arm; it moves only when a command names its serial port.
    struct Driver {
        enum class Protocol { ReachAlpha5, ReachBravo7, Eca5e } protocol = Protocol::ReachAlpha5;
        uint32_t baud = 115200;
        bool rs485 = false; // the kernel switches the transmit direction
        // q = zero + sign * axis reading
        struct Axis {
            std::string axis, joint;
            double sign = 1.0; // 1 or -1
            double zero = 0.0; // [rad] joint value at axis reading 0; for an ECA, at its clockwise stop
        };
        std::vector<Axis> axes; // each joint of the chain once
        // Readings of the gripper axis: [m] for a Reach, [rad] for an ECA.
        struct Jaws {
            double open = 0.0, closed = 0.0;
        };
        std::optional<Jaws> jaws; // empty = the gripper is not driven
        // sustained motor current above which the arm is held [A]; for an ECA the raw byte
        std::optional<double> current;
    };
    std::optional<Driver> driver;
};

struct Scene {
    std::filesystem::path file; // path of the file, for messages and relative paths; empty = built in

    std::vector<std::string> outside; // paths, as written, that leave the file's folder, for a warning

    CameraSource source;
    double nearZ = 0.1, farZ = 3.0; // [m] along the optical axis, inclusive
    Pose baseTcamera;
    uint32_t decimation = 1;        // every nth column and row of the camera's images is used
    bool cameraStatic = false;      // it never moves, though its frames have no poses
    double registrationSigma = 0.0; // [m]; regions grow by 3 of them
    // [1/m] of linear light along the ray from point to lens: red, green, blue (Beer and Lambert). Colours
    // are corrected before the gates; empty = no correction.
    std::optional<dvec3> attenuation;
    std::optional<FlatPort> port;  // the camera looks through a flat port, calibrated in air
    std::optional<BeamSigma> beam; // replaces the sensor's own

    // Depth filter, the first step of every frame.
    struct Filter {
        uint32_t radius = 2;  // [pixels] 0..16; 0 = none
        double sigma = 0.01;  // [m] paper eq. 2
        double edge = 0.03;   // relative depth jump of a flying pixel; 0 = off
        bool isolated = true; // pixels with fewer than two neighbours near them (marine snow) are rejected
        // phi of paper eq. 2: exp(-t) itself, or (1 - t / 16.68)^16 down to 0, which is at most 0.008 off.
        enum class Weights { Exact, Polynomial } weights = Weights::Exact;
        uint32_t memory = 0; // [frames] most that the estimate of a pixel's depth averages; 0 = no estimate
    } filter;
    double errorBudget = 0.0001; // [m]; 0 keeps every point
    double holdSeconds = 0.5;    // [s]; 0 = paper

    static constexpr size_t kMaxFixtures = 64;
    std::vector<FixtureClass> fixtures; // at most kMaxFixtures

    // The spheres of the tool.
    struct ToolSource {
        std::vector<std::array<double, 4>> spheres; // tool frame x y z r [m]
        std::filesystem::path file;                 // of spheres; empty when they are listed
        std::string link;                           // of a file with several links; empty = the only one
        bool given() const { return !spheres.empty() || !file.empty(); } // may be false with an arm only
    } tool;

    std::optional<SceneArm> arm; // carries the tool; empty = the tool moves freely

    // The hand's path, the simulated hand, and the map from hand to tool.
    struct Hand {
        std::string path = "approach"; // built-in name or CSV file
        bool builtIn = true;
        dquat baseRdevice{1.0, 0.0, 0.0, 0.0};
        double scale = 1.0;
        uint32_t clutchBit = kDefaultClutch;
        HandLoop loop;
        bool yields = false; // the path's hand yields to the force as `loop` says
    } hand;

    // The haptic loop.
    struct Haptics {
        double rateHz = 1000.0;                    // [Hz] ticks
        std::string device = "ideal";              // preset name
        std::optional<double> stiffness;           // [N/m]; empty = auto
        std::optional<double> rotationalStiffness; // [N m/rad]; empty = auto
        enum class GuidanceMode { Target, Paper } guidance = GuidanceMode::Target;
        double stepCap = 0.002;                        // [m] leaf travel per solve
        uint32_t solves = 4;                           // solves per tick, at most
        std::optional<double> forceLimit, torqueLimit; // [N], [N m]; empty = the preset's
        double slewForce = 2000.0;                     // [N/s]
        double slewTorque = 50.0;                      // [N m/s]
        double lowpassHz = 0.0;                        // 0 = off
        uint32_t delay = 0;                            // whole ticks from a wrench to the hand
        double pullForce = 2.0, pullTorque = 0.1;      // [N], [N m] largest guidance pull
        double pullSpeed = 0.1;                        // [m/s] at which guidance pulls, at most
        double friction = 0.0;                         // mu between tool and regions
        bool smooth = true;                            // slides on planes over the spheres of a region
        std::optional<double> damping;                 // [N s/m] rendered along the reaction; empty = auto
        double margin = 0.6; // share of the passive bound that automatic stiffness uses
    } haptics;

    // A pilot's profile: the scene's haptics and scale with overrides.
    struct Pilot {
        std::string name;
        Haptics haptics;
        double scale = 1.0; // scale of the hand map
    };
    std::vector<Pilot> pilots;
    std::string pilot; // name of the active one; empty = none
    // Activates that pilot's haptics and scale; false when the name is unknown.
    bool choosePilot(const std::string& name);
    std::string pilotNames() const; // for messages

    struct Window { // the operator's
        double textScale = 1.0;
        bool spaceIsLarge = false;                       // the 3D view is the large one
        double yaw = 0.55, pitch = 0.45, distance = 1.3; // [rad], [m] viewpoint of the 3D view
        bool pilotLayout = false;                        // few figures, large views
        bool tones = true;                               // contact, limit, stale and lost are heard
    };
    std::optional<Window> window;

    // Device of the contact queries, and their reach.
    struct Contact {
        enum class Where { Auto, Cpu, Gpu } where = Where::Auto;
        double reach = 0.01; // [m]
        uint32_t delay = 0;  // ticks until an answer takes effect (lockstep)
    } contact;

    bool hasPoints() const; // any class of points: the frame passes run
    bool hasForbiddenPoints() const;
    bool hasGuidance() const; // any guidance class of points
    bool usesColour() const;  // any class that tests colour
    // [m] Most that the filter moves a point: two fifths of the smallest forbidden radius.
    double filterBound() const;
};

// Reads and checks a scene file. Throws BadInput naming file, field, value and what is allowed; unknown keys
// are rejected with the nearest known key as a suggestion. Relative paths are taken from the scene file's
// folder.
Scene loadScene(const std::filesystem::path& file);
// Same for a text; messages call it `name`. Relative paths are taken from the working directory.
Scene loadSceneText(const std::string& text, const std::string& name);

} // namespace fathom
