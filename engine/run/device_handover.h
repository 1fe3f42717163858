// SPDX-License-Identifier: Apache-2.0
// Coordinates two users of one compute device when it is lost and opened again: the frame thread with its
// passes and a window with its painter.
#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <string>

namespace fathom {

// The device is destroyed when neither user has objects on it, and is in use when both use the new one.
// States: in use -> lost (detected by either) -> released (the window has destroyed its objects; the frame
// thread opens a device) -> offered (the window builds its objects) -> in use, or lost again. Only the frame
// thread waits, and not after its run should stop. Never used by the haptic thread.
class DeviceHandover {
public:
    // Either thread: reports that the device failed. Keeps the first reason of a loss.
    void lose(const std::string& why);
    bool lost() const;     // and no new device is offered
    bool notInUse() const; // lost, or offered and not accepted yet
    std::string why() const;

    // Frame thread, after a loss. Waits until the window has released the device. False: `stop` came first,
    // and the device must not be destroyed.
    bool awaitRelease(const std::atomic<bool>& stop);
    // Frame thread: offers the new device. Waits until the window draws on it. False: the window failed, or
    // `stop`.
    bool offer(const std::atomic<bool>& stop);

    // Window, once per frame that it draws.
    bool wanted() const; // the device is lost: destroy everything on it, then release()
    void release();
    bool offered() const; // build objects on the new device, then accept() or lose()
    void accept();        // no effect unless offered

private:
    enum class State { InUse, Lost, Released, Offered };
    State state() const;
    void change(State from, State to);
    // Waits until the state changes or `stop`; returns the state.
    State awaitOther(State than, const std::atomic<bool>& stop);

    mutable std::mutex mutex_; // guards all below
    std::condition_variable changed_;
    State state_ = State::InUse;
    std::string why_;
};

} // namespace fathom
