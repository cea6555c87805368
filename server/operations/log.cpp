#include "server/operations/log.h"

#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <atomic>
#include <nlohmann/json.hpp>

namespace lightwell {
namespace {

std::atomic<LogFormat> current_format = LogFormat::kText;

spdlog::level::level_enum level_of(LogLevel level) {
  switch (level) {
    case LogLevel::kDebug:
      return spdlog::level::debug;
    case LogLevel::kInfo:
      return spdlog::level::info;
    case LogLevel::kWarning:
      return spdlog::level::warn;
    case LogLevel::kError:
      break;
  }
  return spdlog::level::err;
}

nlohmann::ordered_json json_of(const LogValue& value) {
  return std::visit([](const auto& known) { return nlohmann::ordered_json(known); }, value.value);
}

std::string dumped(const nlohmann::ordered_json& json) {
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

/// Members of a JSON object without its braces: the pattern puts the time and the level before them.
std::string json_line(std::string_view event, std::initializer_list<LogValue> values) {
  nlohmann::ordered_json object{{"event", event}};
  for (const LogValue& value : values) object[std::string(value.name)] = json_of(value);
  const std::string text = dumped(object);
  return text.substr(1, text.size() - 2);
}

/// "session_ended session=3f9a reason="the session was ended"": a value in quotes where it holds more than a word.
std::string text_line(std::string_view event, std::initializer_list<LogValue> values) {
  std::string text(event);
  for (const LogValue& value : values) {
    const auto* words = std::get_if<std::string>(&value.value);
    const bool is_word = words && !words->empty() && words->find_first_of(" \"=\n\r\t\\") == std::string::npos;
    text.append(" ").append(value.name).append("=").append(is_word ? *words : dumped(json_of(value)));
  }
  return text;
}

}  // namespace

void set_up_log(LogFormat format, LogLevel least) {
  current_format = format;
  auto logger = std::make_shared<spdlog::logger>("lightwell", std::make_shared<spdlog::sinks::stderr_color_sink_mt>());
  logger->set_level(level_of(least));
  logger->flush_on(spdlog::level::debug);
  constexpr auto kTime = spdlog::pattern_time_type::utc;
  if (format == LogFormat::kJson)
    logger->set_formatter(
        std::make_unique<spdlog::pattern_formatter>(R"({"time":"%Y-%m-%dT%H:%M:%S.%eZ","level":"%l",%v})", kTime));
  else
    logger->set_formatter(std::make_unique<spdlog::pattern_formatter>("%Y-%m-%d %H:%M:%S.%e %^%l%$ %v", kTime));
  spdlog::set_default_logger(std::move(logger));
}

void log_event(LogLevel level, std::string_view event, std::initializer_list<LogValue> values) {
  if (!spdlog::should_log(level_of(level))) return;
  try {
    const bool json = current_format == LogFormat::kJson;
    spdlog::log(level_of(level), json ? json_line(event, values) : text_line(event, values));
  } catch (const std::exception&) {  // out of memory: there is nobody left to tell
  }
}

}  // namespace lightwell
