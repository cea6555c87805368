// Names that nobody guesses.
#pragma once

#include <string>

namespace lightwell {

/// 32 hexadecimal digits from the kernel's random numbers.
std::string random_id();

}  // namespace lightwell
