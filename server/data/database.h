// A thin cover over SQLite: statements with values, rows with columns. Errors are DatabaseError: nothing that clients
// say makes the database fail, but a disk, another process or who runs the server can.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>

struct sqlite3;
struct sqlite3_stmt;

namespace lightwell {

/// Names the file and what SQLite says of it. Another try may do.
class DatabaseError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Not thread-safe: callers take turns. Several processes may have the same file open.
class Database {
 public:
  /// Creates the file where there is none.
  explicit Database(const std::filesystem::path& path);
  ~Database();
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  /// One or several statements without values or rows.
  void execute(const char* sql);
  /// The same, for what may be run again and again, as a schema: waits for other processes that do so at the same time,
  /// also where SQLite would rather refuse than wait, as for a change of the journal's mode.
  void set_up(const char* sql);
  /// Rows that the last statement changed.
  int changes() const;

 private:
  friend class Statement;
  [[noreturn]] void fail(const char* doing) const;

  std::string path_;
  sqlite3* handle_ = nullptr;
};

/// One statement, run once: bind, then `next` until it gives false.
class Statement {
 public:
  Statement(Database& database, const char* sql);
  ~Statement();
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;

  /// Values for ?1, ?2, ... in order.
  Statement& bind(const std::string& text);
  Statement& bind(std::int64_t number);
  Statement& bind(double number);

  /// True if there is a row to read.
  bool next();
  /// Runs it to its end.
  void run() {
    while (next()) {
    }
  }

  std::string text(int column) const;
  std::int64_t integer(int column) const;

 private:
  Database& database_;
  sqlite3_stmt* handle_ = nullptr;
  int bound_ = 0;
};

/// All or nothing: what is not committed is rolled back.
class Transaction {
 public:
  explicit Transaction(Database& database) : database_(database) { database_.execute("BEGIN IMMEDIATE"); }
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;

  void commit() {
    database_.execute("COMMIT");
    done_ = true;
  }

 private:
  Database& database_;
  bool done_ = false;
};

}  // namespace lightwell
