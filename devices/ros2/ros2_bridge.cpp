// SPDX-License-Identifier: Apache-2.0
#include "devices/ros2/ros2_bridge.h"

#include "devices/bag/ros2_messages.h"
#include "devices/ros2/first_publisher.h"
#include "devices/ros2/received_messages.h"
#include "engine/types/clock.h"
#include "engine/types/error.h"
#include "engine/types/log.h"

#include <chrono>
#include <set>

namespace fathom {

namespace {

constexpr auto kQuiet = std::chrono::seconds(5); // after a loss was logged

class TopicBridge final : public Ros2Bridge {
public:
    TopicBridge(const Ros2HandRequest& request, const SocketServer::Options& options)
        : request_(request)
        , graph_(Ros2Graph::join(request.place))
        , inbox_(graph_)
        , wrench_(graph_, request.wrench, "geometry_msgs/msg/WrenchStamped", Ros2Qos::Reliable)
        , poses_{inbox_.subscribe(request.pose, "geometry_msgs/msg/PoseStamped", Ros2Qos::Sensor),
                 {"guard ros2", request.pose}}
        , joy_{{}, {"guard ros2", request.joy}, {}, {}}
        , endpoint_(options) {
        if (!request.joy.empty()) {
            joy_.topic = inbox_.subscribe(request.joy, "sensor_msgs/msg/Joy", Ros2Qos::Sensor);
        }
    }
    ~TopicBridge() override { publish({}); }

    void run(const std::atomic<bool>& stop) override;
    std::string place() const override {
        return request_.pose + " in domain " + std::to_string(request_.place.domain) + " on network " +
               request_.place.network;
    }
    const Ros2BridgeFigures& figures() const noexcept override { return figures_; }
    const SocketServer& endpoint() const noexcept override { return endpoint_; }

private:
    void takePoses();
    void takeButtons();
    void watch();
    uint32_t buttons() const;
    void skip(const std::string& topic, const Error& fault);
    void publish(const Wrench& wrench) noexcept;

    struct Poses {
        size_t topic;
        FirstPublisher publisher;
        bool there = false;                          // they come
        Clock::time_point receivedAt = Clock::now(); // the newest
        bool lossLogged = false;
        Clock::time_point quietUntil = {}; // of the log
    };
    struct Joy {
        std::optional<size_t> topic; // none: no buttons
        FirstPublisher publisher;
        std::vector<bool> down;
        Clock::time_point receivedAt;
    };

    Ros2HandRequest request_;
    std::shared_ptr<Ros2Graph> graph_;
    Ros2Inbox inbox_;
    Ros2Writer wrench_;
    Poses poses_;
    Joy joy_;
    HandSample sample_;
    std::string frame_;
    std::set<std::string> faults_;
    Ros2BridgeFigures figures_;
    SocketServer endpoint_;
};

void TopicBridge::skip(const std::string& topic, const Error& fault) {
    constexpr size_t kMaxFaults = 32;
    ++figures_.faults;
    const std::string text = topic + ": " + fault.what();
    if (faults_.size() < kMaxFaults && faults_.insert(text).second) {
        log::warn("guard ros2: message skipped: {} (logged once)", text);
    }
}

void TopicBridge::takePoses() {
    for (const Ros2Message& taken : inbox_.take(poses_.topic)) {
        if (!poses_.publisher.accepts(taken)) {
            continue;
        }
        try {
            ros2::HandPose hand = ros2::handPose(taken.message->bytes());
            sample_.deviceThandle = hand.pose;
            frame_ = std::move(hand.frame);
            figures_.late += poses_.there && secondsSince(poses_.receivedAt) > kLate ? 1 : 0;
            poses_.receivedAt = Clock::now();
            ++figures_.replies;
            if (!poses_.there && poses_.lossLogged) {
                log::warn("{}: poses again", request_.pose);
                poses_.lossLogged = false;
            }
            poses_.there = true;
        } catch (const Error& e) {
            skip(request_.pose, e);
        }
    }
}

void TopicBridge::takeButtons() {
    if (!joy_.topic) {
        return;
    }
    for (const Ros2Message& taken : inbox_.take(*joy_.topic)) {
        if (!joy_.publisher.accepts(taken)) {
            continue;
        }
        try {
            joy_.down = ros2::joyButtons(taken.message->bytes());
            joy_.receivedAt = Clock::now();
        } catch (const Error& e) {
            skip(request_.joy, e);
        }
    }
}

uint32_t TopicBridge::buttons() const {
    const bool fresh = joy_.down.size() > 0 && secondsSince(joy_.receivedAt) <= kJoySilence;
    const auto down = [&](uint32_t button) {
        return fresh && button < joy_.down.size() && joy_.down[button];
    };
    const bool open = request_.deadMan && !down(*request_.deadMan);
    return (down(request_.guidance) ? FATHOM_DOOR_GUIDANCE : 0) |
           (down(request_.clutch) ? FATHOM_DOOR_CLUTCH : 0) | (open ? FATHOM_DOOR_DEAD_MAN_OPEN : 0);
}

void TopicBridge::watch() {
    if (poses_.there && secondsSince(poses_.receivedAt) > kSilence) {
        poses_.there = false;
        ++figures_.losses;
        if (Clock::now() >= poses_.quietUntil) {
            log::warn("{}: no pose for {} s: reported to the engine", request_.pose, kSilence);
            poses_.lossLogged = true;
            poses_.quietUntil = Clock::now() + kQuiet;
        }
    }
}

void TopicBridge::publish(const Wrench& wrench) noexcept {
    try {
        wrench_.write(ros2::wrench({utcNanoseconds(), frame_}, wrench.force, wrench.torque));
    } catch (const std::bad_alloc&) { // the node then stops the force
    }
}

void TopicBridge::run(const std::atomic<bool>& stop) {
    auto due = Clock::now();
    while (!stop.load()) {
        inbox_.wait(std::max(0.0, -secondsSince(due)));
        takePoses();
        takeButtons();
        watch();
        endpoint_.poll();
        if (Clock::now() >= due) {
            due = std::max(
                due + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(kPeriod)),
                Clock::now());
            sample_.buttons = buttons();
            endpoint_.send(sample_, poses_.there ? FATHOM_DOOR_PRESENT | FATHOM_DOOR_HOMED : 0);
            publish(poses_.there ? endpoint_.wrench() : Wrench{});
        }
    }
    publish({});
}

} // namespace

std::unique_ptr<Ros2Bridge> openRos2Bridge(const Ros2HandRequest& request,
                                           const std::filesystem::path& endpoint, double forceLimit,
                                           double torqueLimit) {
    return std::make_unique<TopicBridge>(
        request,
        SocketServer::Options{endpoint, request.preset, "ROS 2 " + request.pose, forceLimit, torqueLimit});
}

} // namespace fathom
