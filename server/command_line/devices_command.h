// `lightwell devices`: what was found, what was chosen and why.
#pragma once

#include "server/command_line/exit_code.h"

namespace CLI {
class App;
}

namespace lightwell {

struct DevicesArguments {
  bool json = false;
};

void add_devices_options(CLI::App& app, DevicesArguments& arguments);

/// kNoUsableDevice if none of the devices gives a context; the list is printed all the same.
ExitCode run_devices(const DevicesArguments& arguments);

}  // namespace lightwell
