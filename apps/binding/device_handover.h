// SPDX-License-Identifier: Apache-2.0
// Who has something on a device that two threads share, when it is lost and made anew: the frame cadence its
// passes, the window its painter.
#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <string>

namespace fathom {

// A device is destroyed when nobody has anything on it any more, and counts as back when both can use it:
//   there -> lost (either finds out) -> released (the window is off it; the frame cadence opens another)
//         -> offered (the window builds on it) -> there, or lost again.
// Only the frame cadence ever waits, and not once its run is to stop. Never used by the haptic thread.
class DeviceHandover {
public:
    // Either thread: the device does not work. The first reason of a loss is kept.
    void lose(const std::string& why);
    bool lost() const; // and nobody has offered another
    bool gone() const; // or nothing is drawn on the other one yet
    std::string why() const;

    // Frame cadence, of a lost device. Waits until the window is off it; false: `stop` came first, and the
    // device must stay.
    bool awaitRelease(const std::atomic<bool>& stop);
    // Frame cadence: another one is open. Waits until the window draws on it; false: it could not, or `stop`.
    bool offer(const std::atomic<bool>& stop);

    // Window, once a frame.
    bool wanted() const; // the device is lost: destroy all that is on it, then release()
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
