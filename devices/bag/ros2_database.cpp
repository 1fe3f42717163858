// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/ros2_database.h"

#include "devices/bag/unpack_chunk.h"
#include "engine/types/error.h"
#include "engine/types/read_file.h"

#include <map>
#include <sqlite3.h>

namespace fathom {

namespace {

constexpr int kDatabaseBytes = 1 << 30;            // of one message
constexpr uint64_t kDatabaseMessages = 20'000'000; // of a file
constexpr size_t kDatabaseTopics = 10'000;
constexpr int kStepsPerCall = 100'000; // of SQLite's machine
constexpr uint64_t kMaxCalls = 20'000; // so a crafted schema cannot run for ever

int countSteps(void* calls) {
    return ++*static_cast<uint64_t*>(calls) > kMaxCalls ? 1 : 0;
}

std::string textAt(sqlite3_stmt* statement, int column) {
    const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(statement, column));
    return text == nullptr ? "" : printable(text);
}

// A path in a URI: what would end it is escaped.
std::string uriOf(const std::filesystem::path& file) {
    std::string uri = "file:";
    for (const char c : file.string()) {
        uri += c == '%' ? "%25" : (c == '?' ? "%3f" : (c == '#' ? "%23" : std::string(1, c)));
    }
    std::error_code failed;
    const bool log = std::filesystem::exists(file.string() + "-wal", failed);
    return uri + (log ? "?mode=ro" : "?mode=ro&immutable=1");
}

} // namespace

void Ros2Database::Close::operator()(sqlite3* database) const noexcept {
    sqlite3_close_v2(database);
}

void Ros2Database::Close::operator()(sqlite3_stmt* statement) const noexcept {
    sqlite3_finalize(statement);
}

Ros2Database::Ros2Database(const std::filesystem::path& file)
    : MessageFile(file) {
    if (!isRegularFile(file)) {
        throw BadInput(file.string(), "file", whyUnreadable(file), "a ROS 2 database");
    }
    try {
        open();
        checkTables();
        readIndex();
        one_ = prepare("SELECT data FROM messages WHERE id = ?1");
    } catch (const BadInput&) {
        throw;
    } catch (const Error& e) {
        throw BadInput(file.string(), "content", e.what(), "a ROS 2 database (.db3), whole");
    }
}

void Ros2Database::open() {
    sqlite3* made = nullptr;
    const int result =
        sqlite3_open_v2(uriOf(file()).c_str(), &made, SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, nullptr);
    database_.reset(made);
    if (result != SQLITE_OK) {
        throw Error(sqlite3_errstr(result));
    }
    sqlite3_db_config(made, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
    sqlite3_limit(made, SQLITE_LIMIT_LENGTH, kDatabaseBytes);
    sqlite3_progress_handler(made, kStepsPerCall, countSteps, &steps_);
}

Ros2Database::Statement Ros2Database::prepare(const char* text) {
    sqlite3_stmt* made = nullptr;
    if (sqlite3_prepare_v2(database_.get(), text, -1, &made, nullptr) != SQLITE_OK) {
        throw Error(sqlite3_errmsg(database_.get()));
    }
    return Statement(made);
}

bool Ros2Database::step(sqlite3_stmt* statement) {
    const int result = sqlite3_step(statement);
    if (result != SQLITE_ROW && result != SQLITE_DONE) {
        throw Error(sqlite3_errmsg(database_.get()));
    }
    return result == SQLITE_ROW;
}

void Ros2Database::checkTables() {
    const Statement tables =
        prepare("SELECT count(*) FROM sqlite_master WHERE type = 'table' AND name IN ('topics', 'messages')");
    if (!step(tables.get()) || sqlite3_column_int(tables.get(), 0) != 2) {
        throw BadInput(file().string(), "tables", "not those of a ROS 2 recording", "topics and messages");
    }
}

void Ros2Database::readIndex() {
    std::map<int64_t, size_t> topicOf;
    const Statement topics = prepare("SELECT id, name, type, serialization_format FROM topics");
    while (step(topics.get())) {
        if (topicOf.size() >= kDatabaseTopics) {
            throw Error("more than " + std::to_string(kDatabaseTopics) + " topics");
        }
        const std::string format = textAt(topics.get(), 3), type = textAt(topics.get(), 2);
        topicOf[sqlite3_column_int64(topics.get(), 0)] =
            topicAt(textAt(topics.get(), 1), format == "cdr" ? type : format + " " + type, format == "cdr");
    }
    const Statement messages = prepare("SELECT id, topic_id, timestamp FROM messages");
    for (uint64_t total = 0; step(messages.get()); ++total) {
        if (total >= kDatabaseMessages) {
            throw Error("more than " + std::to_string(kDatabaseMessages) + " messages");
        }
        const auto topic = topicOf.find(sqlite3_column_int64(messages.get(), 1));
        if (topic != topicOf.end()) {
            // The RealSense SDK gives what holds for the whole recording the earliest time that there is.
            const int64_t time = std::max<int64_t>(0, sqlite3_column_int64(messages.get(), 2));
            topics_[topic->second].messages.push_back(
                {static_cast<uint64_t>(time), 0,
                 static_cast<uint64_t>(sqlite3_column_int64(messages.get(), 0))});
        }
    }
    sortByTime();
}

MessageBytes Ros2Database::bytes(const MessageEntry& entry) {
    steps_ = 0;
    sqlite3_reset(one_.get());
    sqlite3_bind_int64(one_.get(), 1, static_cast<sqlite3_int64>(entry.offset));
    if (!step(one_.get())) {
        throw Error("a message is missing");
    }
    const auto* data = static_cast<const uint8_t*>(sqlite3_column_blob(one_.get(), 0));
    const auto size = static_cast<size_t>(sqlite3_column_bytes(one_.get(), 0));
    std::vector<uint8_t> message(data, data + (data == nullptr ? 0 : size));
    sqlite3_reset(one_.get());
    return unpackMessage(MessageBytes::of(std::move(message)));
}

} // namespace fathom
