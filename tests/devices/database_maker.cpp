// SPDX-License-Identifier: Apache-2.0
#include "tests/devices/database_maker.h"

#include "tests/devices/bag_maker.h"

#include <doctest/doctest.h>
#include <map>
#include <sqlite3.h>
#include <zstd.h>

namespace fathom::testing {

namespace {

constexpr size_t kHeader = 4; // [bytes] in front of the values

void pad(Out& out) {
    while ((out.bytes.size() - kHeader) % 4 != 0) {
        out.put(uint8_t{0});
    }
}

Out begunCdr() {
    return Out{std::string("\0\1\0\0", kHeader)};
}

void putText(Out& out, const std::string& text) {
    out.text(text + '\0');
    pad(out);
}

void run(sqlite3* database, const char* text, const std::vector<std::string>& texts, int64_t one = 0,
         int64_t other = 0) {
    sqlite3_stmt* statement = nullptr;
    REQUIRE(sqlite3_prepare_v2(database, text, -1, &statement, nullptr) == SQLITE_OK);
    sqlite3_bind_int64(statement, 1, one);
    sqlite3_bind_int64(statement, 2, other);
    for (size_t i = 0; i < texts.size(); ++i) {
        sqlite3_bind_blob(statement, static_cast<int>(3 + i), texts[i].data(),
                          static_cast<int>(texts[i].size()), SQLITE_TRANSIENT);
    }
    CHECK(sqlite3_step(statement) == SQLITE_DONE);
    sqlite3_finalize(statement);
}

} // namespace

void writeDatabase(const std::filesystem::path& file, const std::vector<DatabaseMessage>& messages) {
    std::filesystem::remove(file);
    sqlite3* database = nullptr;
    REQUIRE(sqlite3_open(file.c_str(), &database) == SQLITE_OK);
    sqlite3_exec(database,
                 "PRAGMA page_size = 512; BEGIN;"
                 "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,"
                 " serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL);"
                 "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL,"
                 " timestamp INTEGER NOT NULL, data BLOB NOT NULL)",
                 nullptr, nullptr, nullptr);
    std::map<std::string, int64_t> topics;
    for (const DatabaseMessage& message : messages) {
        const auto [topic, isNew] = topics.emplace(message.topic, topics.size() + 1);
        if (isNew) {
            run(database, "INSERT INTO topics VALUES(?1, CAST(?3 AS TEXT), CAST(?4 AS TEXT), 'cdr', '')",
                {message.topic, message.type}, topic->second);
        }
        run(database, "INSERT INTO messages(topic_id, timestamp, data) VALUES(?1, ?2, ?3)", {message.bytes},
            topic->second, message.time);
    }
    sqlite3_exec(database, "COMMIT", nullptr, nullptr, nullptr);
    sqlite3_close(database);
}

std::vector<DatabaseMessage> packedOneByOne(std::vector<DatabaseMessage> messages) {
    for (DatabaseMessage& message : messages) {
        std::string packed(ZSTD_compressBound(message.bytes.size()), '\0');
        packed.resize(
            ZSTD_compress(packed.data(), packed.size(), message.bytes.data(), message.bytes.size(), 1));
        message.bytes = packed;
    }
    return messages;
}

std::string textCdr(const std::string& text) {
    Out out = begunCdr();
    out.text(text + '\0');
    return out.bytes;
}

std::string imageCdr(int64_t time, const CdrImage& image) {
    constexpr int64_t kSecond = 1'000'000'000;
    Out out = begunCdr();
    out.put(static_cast<int32_t>(time / kSecond)).put(static_cast<uint32_t>(time % kSecond));
    putText(out, image.frame);
    out.put(image.height).put(image.width);
    out.text(image.encoding + '\0').put(uint8_t{0});
    pad(out);
    return out.put(image.step).text(image.pixels).bytes;
}

} // namespace fathom::testing
