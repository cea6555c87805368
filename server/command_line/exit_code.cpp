#include "server/command_line/exit_code.h"

#include <cstdio>

namespace lightwell {

ExitCode exit_code_of(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::kInvalidInput:
    case ErrorKind::kNotFound:
    case ErrorKind::kTooLarge:
    case ErrorKind::kUnsupported:
      return kBadInput;
    case ErrorKind::kNoDevice:
      return kNoUsableDevice;
    case ErrorKind::kDeviceLost:
    case ErrorKind::kUnwanted:
    case ErrorKind::kInternal:
      break;
  }
  return kFailed;
}

ExitCode report(const Error& error) {
  std::fprintf(stderr, "lightwell: %s\n", error.message().c_str());
  return exit_code_of(error.kind);
}

ExitCode report_usage(const Error& error) {
  std::fprintf(stderr, "lightwell: %s\nRun with --help for more information.\n", error.message().c_str());
  return kWrongUsage;
}

}  // namespace lightwell
