// SPDX-License-Identifier: Apache-2.0
#include "engine/model/urdf_file.h"

#include "engine/types/error.h"
#include "engine/types/read_file.h"

#include <console_bridge/console.h>
#include <optional>
#include <urdf_model/pose.h>
#include <urdf_parser/urdf_parser.h>

namespace fathom {

namespace {

constexpr size_t kLargestUrdf = 64u << 20;

// Takes what the parser would print, so that it becomes part of one line of ours.
class Listener : public console_bridge::OutputHandler {
public:
    Listener()
        : before_(console_bridge::getOutputHandler()) {
        console_bridge::useOutputHandler(this);
    }
    Listener(const Listener&) = delete;
    Listener& operator=(const Listener&) = delete;
    ~Listener() override { console_bridge::useOutputHandler(before_); }
    void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
        if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR && first_.empty()) {
            first_ = text.substr(0, text.find('\n'));
        }
    }
    const std::string& first() const { return first_; }

private:
    console_bridge::OutputHandler* before_;
    std::string first_;
};

} // namespace

std::shared_ptr<const urdf::ModelInterface> readUrdf(const std::filesystem::path& file) {
    const std::optional<std::string> read = readFileAtMost(file, kLargestUrdf);
    if (!read || read->empty() || read->size() > kLargestUrdf) {
        throw BadInput(file.string(), "file",
                       read && !read->empty() ? "over 64 MiB" : "cannot be read or empty",
                       "a readable URDF file");
    }
    const std::string& text = *read;
    const Listener listener;
    std::shared_ptr<const urdf::ModelInterface> model = urdf::parseURDF(text);
    if (!model) {
        throw BadInput(file.string(), "robot", listener.first().empty() ? "not understood" : listener.first(),
                       "a URDF robot");
    }
    return model;
}

Pose poseOf(const urdf::Pose& pose) {
    const urdf::Rotation& r = pose.rotation;
    return {{pose.position.x, pose.position.y, pose.position.z}, glm::normalize(dquat(r.w, r.x, r.y, r.z))};
}

} // namespace fathom
