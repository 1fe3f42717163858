// SPDX-License-Identifier: Apache-2.0
// A ROS 2 recording in an SQLite database (.db3). Source: rosbag2_storage_sqlite3.
#pragma once

#include "devices/bag/message_file.h"

struct sqlite3;
struct sqlite3_stmt;

namespace fathom {

// Messages may be compressed one by one (zstd).
class Ros2Database final : public MessageFile {
public:
    // Opens it for reading only. Throws BadInput that names the file: not a database, or one without the
    // tables `topics` and `messages`.
    explicit Ros2Database(const std::filesystem::path& file);
    MessageBytes bytes(const MessageEntry& entry) override;

private:
    struct Close {
        void operator()(sqlite3* database) const noexcept;
        void operator()(sqlite3_stmt* statement) const noexcept;
    };
    using Statement = std::unique_ptr<sqlite3_stmt, Close>;
    void open();
    Statement prepare(const char* text);
    bool step(sqlite3_stmt* statement);
    void checkTables();
    void readIndex();

    std::unique_ptr<sqlite3, Close> database_;
    Statement one_; // data of one message
    uint64_t steps_ = 0;
};

} // namespace fathom
