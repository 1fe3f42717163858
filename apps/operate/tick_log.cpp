// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/tick_log.h"

#include "devices/recorded/text_file.h"
#include "engine/types/error.h"

#include <algorithm>
#include <cmath>
#include <ostream>

namespace fathom::operate {

namespace {

constexpr const char* kShortHeader = "t_s,fx,fy,fz,tx,ty,tz,contacts,state";
constexpr size_t kShort = 9, kSevenJoints = 37, kTouchColumns = 13;
constexpr size_t kFirstJoints = 7; // before the grasp; the others follow it
constexpr const char* kMoreJoints = ",q8";
constexpr size_t kTwelveJoints = kSevenJoints + kMaxJoints - kFirstJoints;
constexpr const char* kResidual = ",residual_fx";
constexpr size_t kAll = kTwelveJoints + 6;

void put(std::ostream& out, const dvec3& v) {
    out << "," << v.x << "," << v.y << "," << v.z;
}

void put(std::ostream& out, const Pose& pose) {
    put(out, pose.position);
    const dquat& q = pose.rotation;
    out << "," << q.w << "," << q.x << "," << q.y << "," << q.z;
}

// A CSV file of numbers, line by line.
class NumberRows {
public:
    explicit NumberRows(const std::filesystem::path& file)
        : name_(file.string())
        , lines_(file) {
        lines_.next(line_);
    }
    const std::string& head() const { return line_.text; } // before the first next()

    bool next(size_t columns) {
        if (!lines_.next(line_)) {
            return false;
        }
        values_.clear();
        for (std::string_view field : splitFields(line_.text, ',')) {
            values_.emplace_back();
            if (!parseNumber(field, values_.back())) {
                refuse(", column " + std::to_string(values_.size()), std::string(field), "a number");
            }
        }
        if (values_.size() != columns) {
            refuse("", std::to_string(values_.size()) + " fields", std::to_string(columns));
        }
        return true;
    }
    double operator[](size_t i) const { return values_[i]; }
    dvec3 vec(size_t i) const { return {values_[i], values_[i + 1], values_[i + 2]}; }
    Pose pose(size_t i) const {
        const dquat q(values_[i + 3], values_[i + 4], values_[i + 5], values_[i + 6]);
        return {vec(i), glm::dot(q, q) > 0.0 ? glm::normalize(q) : dquat(1.0, 0.0, 0.0, 0.0)};
    }
    // An integer from 0 to `most` in column i.
    uint32_t whole(size_t i, double most) const {
        const double value = values_[i];
        if (!(value >= 0.0 && value <= most && value == std::floor(value))) {
            refuse(", column " + std::to_string(i + 1), std::to_string(value),
                   "a whole number from 0 to " + std::to_string(static_cast<uint64_t>(most)));
        }
        return static_cast<uint32_t>(value);
    }
    [[noreturn]] void refuse(const std::string& where, const std::string& value,
                             const std::string& allowed) const {
        throw BadInput(name_, "line " + std::to_string(line_.number) + where, "'" + value.substr(0, 80) + "'",
                       allowed);
    }

private:
    std::string name_;
    DataLines lines_;
    TextLine line_{1, ""};
    std::vector<double> values_;
};

RecordedTick tickFrom(const NumberRows& row, size_t columns) {
    RecordedTick m;
    m.t = row[0];
    m.wrench = {row.vec(1), row.vec(4)};
    m.contacts = row.whole(7, 1e9);
    m.state = static_cast<StepState>(row.whole(8, static_cast<double>(StepState::Waiting)));
    if (columns > kShort) {
        m.guidance = row[9];
        m.guidanceClass = static_cast<int>(row.whole(10, 1e6)) - 1;
        m.sceneAge = row[11];
        m.frame = static_cast<int64_t>(row.whole(12, 4e9)) - 1;
        m.marginPassive = row[13];
        m.marginUncoupled = row[14];
        m.device = row.pose(15);
        m.tool = row.pose(22);
        for (size_t k = 0; k < kFirstJoints; ++k) {
            m.arm.q[k] = row[29 + k];
        }
        m.arm.grasp = row[36];
        for (size_t i = kSevenJoints; i < std::min(columns, kTwelveJoints); ++i) {
            m.arm.q[kFirstJoints + i - kSevenJoints] = row[i];
        }
        if (columns == kAll) {
            m.residual = {row.vec(kTwelveJoints), row.vec(kTwelveJoints + 3)};
        }
    }
    return m;
}

Touch touchFrom(const NumberRows& row) {
    Touch touch;
    touch.kind = static_cast<ContactRow::Kind>(row.whole(1, static_cast<double>(ContactRow::Kind::Behind)));
    touch.fixture = row.whole(2, 4294967295.0);
    touch.leaf = row.whole(3, 4294967295.0);
    touch.source = row.whole(4, 4294967295.0);
    touch.point = row.vec(5);
    touch.normal = row.vec(8);
    touch.gap = row[11];
    touch.multiplier = row[12];
    return touch;
}

void readTouches(const std::filesystem::path& file, TickLog& log) {
    NumberRows row(file);
    if (row.head() != touchesHeader()) {
        row.refuse("", row.head(), touchesHeader());
    }
    size_t tick = 0;
    while (row.next(kTouchColumns)) {
        while (tick < log.ticks.size() && log.ticks[tick].t < row[0]) {
            ++tick;
        }
        if (tick == log.ticks.size() && log.cut) {
            return;
        }
        if (tick == log.ticks.size() || log.ticks[tick].t != row[0]) {
            row.refuse(", t_s", std::to_string(row[0]), "the time of a row of wrench.csv, ascending");
        }
        RecordedTick& recorded = log.ticks[tick];
        if (recorded.touchCount >= kMaxTouches) {
            row.refuse("", "one more", "8 touches per tick");
        }
        recorded.firstTouch = recorded.touchCount == 0 ? log.touches.size() : recorded.firstTouch;
        ++recorded.touchCount;
        log.touches.push_back(touchFrom(row));
    }
}

} // namespace

const char* wrenchHeader() {
    return "t_s,fx,fy,fz,tx,ty,tz,contacts,state,guidance,target,scene_age_s,frame,margin_passive,margin_"
           "uncoupled,"
           "device_x,device_y,device_z,device_qw,device_qx,device_qy,device_qz,"
           "tool_x,tool_y,tool_z,tool_qw,tool_qx,tool_qy,tool_qz,q1,q2,q3,q4,q5,q6,q7,grasp,q8,q9,q10,q11,"
           "q12,residual_fx,residual_fy,residual_fz,residual_tx,residual_ty,residual_tz";
}

const char* touchesHeader() {
    return "t_s,kind,fixture,leaf,source,x,y,z,nx,ny,nz,gap,multiplier";
}

void writeTick(std::ostream& wrench, std::ostream& touches, double t, int64_t frame, const StepRecord& tick) {
    wrench << t;
    put(wrench, tick.wrench.force);
    put(wrench, tick.wrench.torque);
    wrench << "," << tick.contactCount << "," << static_cast<int>(tick.state) << "," << tick.guidance << ","
           << tick.guidanceClass + 1 << "," << tick.sceneAge << "," << frame + 1 << "," << tick.marginPassive
           << "," << tick.marginUncoupled;
    put(wrench, tick.device);
    put(wrench, tick.tool);
    for (size_t k = 0; k < kFirstJoints; ++k) {
        wrench << "," << tick.arm.posture.q[k];
    }
    wrench << "," << tick.arm.posture.grasp;
    for (size_t k = kFirstJoints; k < kMaxJoints; ++k) {
        wrench << "," << tick.arm.posture.q[k];
    }
    put(wrench, tick.residual.force);
    put(wrench, tick.residual.torque);
    wrench << "\n";
    for (uint32_t i = 0; i < tick.touchCount; ++i) {
        const Touch& touch = tick.touches[i];
        touches << t << "," << static_cast<int>(touch.kind) << "," << touch.fixture << "," << touch.leaf
                << "," << touch.source;
        put(touches, touch.point);
        put(touches, touch.normal);
        touches << "," << touch.gap << "," << touch.multiplier << "\n";
    }
}

namespace {

// Older versions have fewer columns.
size_t columnsOf(const NumberRows& row) {
    const std::string all = wrenchHeader(), head = row.head();
    if (head == kShortHeader) {
        return kShort;
    }
    for (const auto& [next, columns] :
         {std::pair(kMoreJoints, kSevenJoints), std::pair(kResidual, kTwelveJoints)}) {
        if (head == all.substr(0, all.find(next))) {
            return columns;
        }
    }
    if (head != all) {
        row.refuse("", head, std::string("header ") + kShortHeader + ",...");
    }
    return kAll;
}

} // namespace

TickLog readTickLog(const std::filesystem::path& folder, size_t most) {
    TickLog log;
    if (!std::filesystem::exists(folder / kWrenchFile)) {
        return log;
    }
    NumberRows row(folder / kWrenchFile);
    const size_t columns = columnsOf(row);
    log.poses = columns > kShort;
    while (row.next(columns)) {
        if (!std::isfinite(row[0]) || (!log.ticks.empty() && !(row[0] > log.ticks.back().t))) {
            row.refuse(", t_s", std::to_string(row[0]), "later than the row before");
        }
        if (log.ticks.size() >= most) {
            log.cut = true;
            break;
        }
        log.ticks.push_back(tickFrom(row, columns));
    }
    if (log.poses && std::filesystem::exists(folder / kTouchesFile)) {
        readTouches(folder / kTouchesFile, log);
    }
    return log;
}

StepRecord TickLog::recordAt(size_t i) const {
    const RecordedTick& m = ticks[i];
    StepRecord r;
    r.t = m.t;
    r.device = m.device;
    r.tool = m.tool;
    r.arm.posture = m.arm;
    r.wrench = m.wrench;
    r.residual = m.residual;
    r.contactCount = m.contacts;
    r.state = m.state;
    r.guidance = m.guidance;
    r.guidanceClass = m.guidanceClass;
    r.sceneAge = m.sceneAge;
    r.frame = m.frame;
    r.marginPassive = m.marginPassive;
    r.marginUncoupled = m.marginUncoupled;
    r.touchCount = m.touchCount;
    std::copy_n(touches.begin() + static_cast<std::ptrdiff_t>(m.firstTouch), m.touchCount, r.touches.begin());
    return r;
}

TickRow TickLog::rowAt(size_t i, const HandPath* hand) const {
    TickRow row;
    row.record = recordAt(i);
    row.hand.buttons = hand != nullptr ? hand->at(ticks[i].t).buttons : 0;
    return row;
}

} // namespace fathom::operate
