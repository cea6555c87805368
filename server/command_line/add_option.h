// Options whose text goes through our own parsers, so that every refusal reads alike.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "renderer/error.h"
#include "server/command_line/parse_values.h"

namespace lightwell {

/// Adds `name` to `app`; `parse` turns its text into a Result, and `target` gets the value. `kind` and `shown_default`
/// are for the help.
template <class Target, class Parse>
CLI::Option* add_parsed(CLI::App& app, const std::string& name, Target& target, Parse parse, const std::string& kind,
                        const std::string& help, const std::string& shown_default = "") {
  const auto set = [&target, parse, name](const std::string& text) {
    auto value = parse(text);
    if (!value) throw CLI::ValidationError(name, value.error().message());
    target = *value;
  };
  CLI::Option* option = app.add_option_function<std::string>(name, set, help);
  option->type_name(kind);
  if (!shown_default.empty()) option->default_str(shown_default);
  return option;
}

/// An option that takes an integer in [least, most].
template <class Integer>
CLI::Option* add_integer(CLI::App& app, const std::string& name, Integer& target, long long least, long long most,
                         const std::string& help) {
  const auto parse = [least, most](const std::string& text) -> Result<Integer> {
    const Result<long long> number = parse_integer(text, least, most);
    if (!number) return number.error();
    return static_cast<Integer>(*number);
  };
  return add_parsed(app, name, target, parse, "N", help, std::to_string(target));
}

/// An option that takes one of the names that `value_of_name` knows; `all` is what the help and a refusal list.
template <class Enum, class ValueOfName>
CLI::Option* add_named(CLI::App& app, const std::string& name, Enum& target, std::span<const Enum> all,
                       ValueOfName value_of_name, const std::string& help) {
  std::string names;
  for (const Enum value : all) names += (names.empty() ? "" : "|") + std::string(name_of(value));
  const auto parse = [=](const std::string& text) -> Result<Enum> {
    const std::optional<Enum> value = value_of_name(text);
    if (value) return *value;
    return invalid_input("", "expected one of " + names + ", not \"" + text + "\"");
  };
  return add_parsed(app, name, target, parse, names, help, std::string(name_of(target)));
}
template <class Enum, class ValueOfName>
CLI::Option* add_named(CLI::App& app, const std::string& name, Enum& target, std::initializer_list<Enum> all,
                       ValueOfName value_of_name, const std::string& help) {
  return add_named(app, name, target, std::span<const Enum>(all.begin(), all.size()), value_of_name, help);
}

}  // namespace lightwell
