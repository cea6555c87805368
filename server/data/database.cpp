#include "server/data/database.h"

#include <sqlite3.h>

#include <chrono>
#include <thread>

namespace lightwell {
namespace {

constexpr int kBusyMs = 10'000;  // another process writes: its turn is short

}  // namespace

Database::Database(const std::filesystem::path& path) : path_(path.string()) {
  constexpr int kFlags = SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_NOMUTEX;
  if (sqlite3_open_v2(path_.c_str(), &handle_, kFlags, nullptr) != SQLITE_OK) {
    const std::string why = handle_ ? sqlite3_errmsg(handle_) : "out of memory";
    sqlite3_close(handle_);
    throw DatabaseError(path_ + " cannot be opened: " + why);
  }
  sqlite3_busy_timeout(handle_, kBusyMs);
}

Database::~Database() {
  sqlite3_close(handle_);
}

void Database::fail(const char* doing) const {
  throw DatabaseError(path_ + ": " + sqlite3_errmsg(handle_) + " (" + doing + ")");
}

void Database::execute(const char* sql) {
  if (sqlite3_exec(handle_, sql, nullptr, nullptr, nullptr) != SQLITE_OK) fail(sql);
}

void Database::set_up(const char* sql) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(kBusyMs);
  for (;;) {
    const int result = sqlite3_exec(handle_, sql, nullptr, nullptr, nullptr);
    if (result == SQLITE_OK) return;
    if (result != SQLITE_BUSY || std::chrono::steady_clock::now() > end) fail(sql);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

int Database::changes() const {
  return sqlite3_changes(handle_);
}

Statement::Statement(Database& database, const char* sql) : database_(database) {
  if (sqlite3_prepare_v2(database_.handle_, sql, -1, &handle_, nullptr) != SQLITE_OK) database_.fail(sql);
}

Statement::~Statement() {
  sqlite3_finalize(handle_);
}

Statement& Statement::bind(const std::string& text) {
  const int size = static_cast<int>(text.size());
  if (sqlite3_bind_text(handle_, ++bound_, text.c_str(), size, SQLITE_TRANSIENT) != SQLITE_OK) database_.fail("bind");
  return *this;
}

Statement& Statement::bind(std::int64_t number) {
  if (sqlite3_bind_int64(handle_, ++bound_, number) != SQLITE_OK) database_.fail("bind");
  return *this;
}

Statement& Statement::bind(double number) {
  if (sqlite3_bind_double(handle_, ++bound_, number) != SQLITE_OK) database_.fail("bind");
  return *this;
}

bool Statement::next() {
  const int result = sqlite3_step(handle_);
  if (result != SQLITE_ROW && result != SQLITE_DONE) database_.fail(sqlite3_sql(handle_));
  return result == SQLITE_ROW;
}

std::string Statement::text(int column) const {
  const auto* bytes = sqlite3_column_text(handle_, column);
  if (!bytes) return {};
  return {reinterpret_cast<const char*>(bytes), static_cast<std::size_t>(sqlite3_column_bytes(handle_, column))};
}

std::int64_t Statement::integer(int column) const {
  return sqlite3_column_int64(handle_, column);
}

Transaction::~Transaction() {
  if (done_) return;
  try {
    database_.execute("ROLLBACK");
  } catch (const std::exception&) {  // SQLite has rolled back by itself
  }
}

}  // namespace lightwell
