// SPDX-License-Identifier: Apache-2.0
// Coordinates two users of one compute device when it is lost and opened again: the frame thread with its
// passes and a window with its painter.
#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <string>

namespace fathom {

// The device is destroyed when neither has objects on it, and counts as back when both can use the new one:
//   there -> lost (either detects it) -> released (the window is off it; the frame thread opens another)
//         -> offered (the window builds on it) -> there, or lost again.
// Only the frame thread ever waits, and not once its run is to stop. Never used by the haptic thread.
class DeviceHandover {
public:
    // Either thread: the device failed. The first reason of a loss is kept.
    void lose(const std::string& why);
    bool lost() const; // and no other one is offered
    bool gone() const; // lost, or offered and not accepted yet
    std::string why() const;

    // Frame thread, after a loss. Waits until the window is off the device; false: `stop` came first, and the
    // device must stay.
    bool awaitRelease(const std::atomic<bool>& stop);
    // Frame thread: another device is open. Waits until the window draws on it; false: it could not, or
    // `stop`.
    bool offer(const std::atomic<bool>& stop);

    // Window, once per frame that it draws.
    bool wanted() const; // the device is lost: destroy everything on it, then release()
    void release();
    bool offered() const; // build on the new one, then accept(), or lose() it
    void accept();        // nothing unless offered

private:
    enum class State { There, Lost, Released, Offered };
    State state() const;
    void change(State from, State to);
    // Until the state is another one or `stop`; the state then.
    State awaitOther(State than, const std::atomic<bool>& stop);

    mutable std::mutex mutex_; // of all below
    std::condition_variable changed_;
    State state_ = State::There;
    std::string why_;
};

} // namespace fathom
