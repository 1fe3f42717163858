// SPDX-License-Identifier: Apache-2.0
// Engine and Lockstep.
#include "apps/python/bind.h"
#include "apps/python/unlocked.h"

#include <pybind11/stl/filesystem.h>

#include <mutex>
#include <optional>
#include <set>

namespace py = pybind11;

namespace fathom::python {

namespace {

// Destructors wait for threads of the engine, which may wait for the interpreter's lock to log a line.
struct WithoutLock {
    template <typename T>
    void operator()(T* object) const {
        const Unlocked others;
        delete object;
    }
};

class LiveEngine;

// All of them, so that none has threads when the process ends.
struct LiveEngines {
    std::mutex mutex;
    std::set<LiveEngine*> all;
};
LiveEngines& liveEngines() {
    static LiveEngines engines;
    return engines;
}

// An engine that close() ends.
class LiveEngine {
public:
    LiveEngine(const Scene& scene, const CameraModel& model, const EngineOptions& options)
        : model_(model)
        , engine_(std::make_unique<Engine>(scene, model, options)) {
        const std::lock_guard lock(liveEngines().mutex);
        liveEngines().all.insert(this);
    }
    ~LiveEngine() {
        const std::lock_guard lock(liveEngines().mutex);
        liveEngines().all.erase(this);
    }
    LiveEngine(const LiveEngine&) = delete;
    LiveEngine& operator=(const LiveEngine&) = delete;

    CameraInput camera() { return {open().camera(), model_}; }
    HandPort openHand(const Pose& handle, const std::optional<Pose>& tool) {
        return open().openHand({handle, tool});
    }
    void close() {
        const Unlocked others;
        engine_.reset();
    }
    Engine& open() {
        if (!engine_) {
            throw Error("the engine is closed");
        }
        return *engine_;
    }

private:
    CameraModel model_;
    std::unique_ptr<Engine> engine_;
};

// A lockstep run and what its images must look like.
struct LockstepRun {
    LockstepRun(const Scene& scene, const CameraModel& cameraModel, const HandStart& start,
                const EngineOptions& options)
        : model(cameraModel)
        , run(scene, cameraModel, start, options) {}

    FrameTimes process(const py::array& depth, const py::object& colour, const Pose& baseTcamera,
                       Nanoseconds stamp) {
        const Images both = images(model, depth, colour);
        const Unlocked others;
        return run.process({both.depth, both.colour, baseTcamera, stamp});
    }
    std::optional<Regions> regions() const {
        Regions out;
        const Unlocked others;
        return run.regions(out) ? std::optional(std::move(out)) : std::nullopt;
    }

    CameraModel model;
    Lockstep run;
};

EngineOptions optionsOf(const std::string& computeDevice, const std::string& reader, bool measuredArm) {
    return {computeDevice, reader, measuredArm};
}

void bindLive(py::module_& module) {
    py::class_<LiveEngine, std::unique_ptr<LiveEngine, WithoutLock>>(
        module, "Engine",
        "Owns a compute device and three threads, and hands out ports. Each port belongs to one thread.\n"
        "Use it in a `with` block, or call close().")
        .def(py::init([](const Scene& scene, const CameraModel& camera, const std::string& computeDevice,
                         const std::string& reader, bool measuredArm) {
                 const Unlocked others;
                 return std::unique_ptr<LiveEngine, WithoutLock>(
                     new LiveEngine(scene, camera, optionsOf(computeDevice, reader, measuredArm)));
             }),
             py::arg("scene"), py::arg("camera"), py::kw_only(), py::arg("compute_device") = "",
             py::arg("reader") = "", py::arg("measured_arm") = false,
             "compute_device: part of a Vulkan device's name, or its index; empty = the best one.\n"
             "reader: path of fathom-reader, for scenes with meshes or arms; empty = the installed one.\n"
             "measured_arm: a real arm follows the scene's arm; see open_arm().")
        .def("camera", &LiveEngine::camera, "The CameraPort that takes your frames.")
        .def(
            "open_hand", &LiveEngine::openHand, py::arg("device_T_handle") = Pose{},
            py::arg("base_T_tool") = py::none(),
            "Opens the HandPort, once per engine. base_T_tool: where the tool starts; None = where the hand\n"
            "commands it.")
        .def(
            "open_arm", [](LiveEngine& engine) { return engine.open().openArm(); },
            "Opens the ArmPort of the real arm, once per engine.")
        .def(
            "open_observer", [](LiveEngine& engine) { return engine.open().openObserver(); },
            "Opens the ObserverPort, once per engine.")
        .def_property_readonly(
            "compute_device_lost", [](LiveEngine& engine) { return engine.open().computeDeviceLost(); },
            "true while the engine reopens a lost compute device")
        .def_property_readonly(
            "compute_device_name", [](LiveEngine& engine) { return engine.open().computeDeviceName(); },
            "of the Vulkan device")
        .def_property_readonly(
            "failure", [](LiveEngine& engine) { return engine.open().failure(); },
            "why a thread of the engine ended; empty = none ended")
        .def("close", &LiveEngine::close, "Ends the engine's threads. Ports stay usable: forces fade.")
        .def("__enter__", [](py::object self) { return self; })
        .def("__exit__", [](LiveEngine& engine, const py::args&) { engine.close(); });
}

void bindFrameTimes(py::module_& module) {
    py::class_<FrameTimes>(module, "FrameTimes", "How long one frame took [s].")
        .def_readonly("upload", &FrameTimes::upload, "copy of the images to the compute device")
        .def_readonly("compute", &FrameTimes::compute,
                      "from submission until the compute device has finished")
        .def_readonly("published", &FrameTimes::published,
                      "until steps can use the set; includes both others");
}

void bindLockstep(py::module_& module) {
    py::class_<LockstepRun, std::unique_ptr<LockstepRun, WithoutLock>>(
        module, "Lockstep",
        "The same computation on one thread without a clock. Equal input gives equal output to the last bit.")
        .def(py::init([](const Scene& scene, const CameraModel& camera, const Pose& handle,
                         const std::optional<Pose>& tool, const std::string& computeDevice,
                         const std::string& reader) {
                 const Unlocked others;
                 return std::unique_ptr<LockstepRun, WithoutLock>(
                     new LockstepRun(scene, camera, {handle, tool}, optionsOf(computeDevice, reader, false)));
             }),
             py::arg("scene"), py::arg("camera"), py::arg("device_T_handle") = Pose{},
             py::arg("base_T_tool") = py::none(), py::kw_only(), py::arg("compute_device") = "",
             py::arg("reader") = "")
        .def("process", &LockstepRun::process, py::arg("depth"), py::arg("colour") = py::none(),
             py::kw_only(), py::arg("base_T_camera") = Pose{}, py::arg("stamp"),
             "Computes the fixture set of a frame and makes it the newest; returns FrameTimes. Arrays as in\n"
             "CameraPort.submit(); stamp [ns] on the clock of step().")
        .def(
            "query_contacts",
            [](LockstepRun& lockstep) {
                const Unlocked others;
                return lockstep.run.queryContacts();
            },
            "Answers one contact query at the current tool pose. False before the first frame.")
        .def(
            "step",
            [](LockstepRun& lockstep, const Pose& hand, uint32_t buttons, Nanoseconds time) {
                return lockstep.run.step({hand, static_cast<Button>(buttons)}, time);
            },
            py::arg("device_T_handle"), py::arg("buttons") = 0u, py::kw_only(), py::arg("now"),
            "One haptic step at time `now` [ns]; returns a Step.")
        .def(
            "end_frames", [](LockstepRun& lockstep) { lockstep.run.endFrames(); },
            "No frame will follow: the last one does not age.")
        .def("regions", &LockstepRun::regions, "The Regions of the newest frame; None before the first.")
        .def_property_readonly(
            "period", [](const LockstepRun& lockstep) { return lockstep.run.period(); },
            "[s] between steps that the scene asks for");
}

} // namespace

void bindScene(py::module_& module) {
    py::class_<Scene>(module, "Scene", "A scene, read and checked: Scene.from_file() or Scene.from_text().")
        .def_static("from_file", &Scene::fromFile, py::arg("file"), py::call_guard<Unlocked>(),
                    "Reads a scene file (YAML).")
        .def_static("from_text", &Scene::fromText, py::arg("yaml"), py::call_guard<Unlocked>(),
                    "The same from text. Relative paths start at the working directory.");
}

void closeEngines() {
    std::set<LiveEngine*> all;
    {
        const std::lock_guard lock(liveEngines().mutex);
        all = liveEngines().all;
    }
    for (LiveEngine* engine : all) {
        engine->close();
    }
}

void bindEngine(py::module_& module) {
    bindLive(module);
    bindFrameTimes(module);
    bindLockstep(module);
}

} // namespace fathom::python
