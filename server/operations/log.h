// What the server tells of itself on standard error: events with named values, as text for people or as JSON lines.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <variant>

namespace lightwell {

enum class LogFormat { kText, kJson };
enum class LogLevel { kDebug, kInfo, kWarning, kError };

/// From here on. kInfo and text if it was never called.
void set_up_log(LogFormat format, LogLevel least);

struct LogValue {
  std::string_view name;  // snake_case, with its unit
  std::variant<std::string, double, std::int64_t> value;
};

/// One line: {"time":"2024-05-01T12:00:00.000Z","level":"info","event":"session_ended","session":"..."}, or the same as
/// words. `event` is snake_case. Never throws; cheap when the level is not logged.
void log_event(LogLevel level, std::string_view event, std::initializer_list<LogValue> values = {});

}  // namespace lightwell
