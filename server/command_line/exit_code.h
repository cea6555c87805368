// What the process says to whoever started it.
#pragma once

#include "renderer/error.h"

namespace lightwell {

enum ExitCode : int {
  kDone = 0,
  kFailed = 1,         // anything else
  kWrongUsage = 2,     // the command line itself
  kBadInput = 3,       // a scene or picture that cannot be used
  kNoUsableDevice = 4  // no OpenGL 4.5 core context
};

ExitCode exit_code_of(ErrorKind kind);

/// Prints "lightwell: <message>" to stderr and gives the code for it.
ExitCode report(const Error& error);

/// The same for an error of the command line: kWrongUsage whatever its kind.
ExitCode report_usage(const Error& error);

}  // namespace lightwell
