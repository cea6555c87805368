// Always-on checks for a programmer's mistake: they print both values and stop.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <string>

namespace lightwell::detail {

template <class A, class B>
[[noreturn]] void check_failed(const char* file, int line, const char* text, const A& a, const B& b) {
  std::ostringstream message;
  message << file << ':' << line << ": check failed: " << text << " (" << a << " against " << b << ")\n";
  std::fputs(message.str().c_str(), stderr);
  std::abort();
}

}  // namespace lightwell::detail

#define LIGHTWELL_CHECK_OP(a, op, b)                                                              \
  do {                                                                                            \
    const auto& check_a = (a);                                                                    \
    const auto& check_b = (b);                                                                    \
    if (!(check_a op check_b))                                                                    \
      ::lightwell::detail::check_failed(__FILE__, __LINE__, #a " " #op " " #b, check_a, check_b); \
  } while (false)

#define LIGHTWELL_CHECK(condition) LIGHTWELL_CHECK_OP(static_cast<bool>(condition), ==, true)
