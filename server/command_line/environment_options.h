// --environment and what goes with it, for the commands that show a scene.
#pragma once

#include "renderer/image_io/environment_file.h"

namespace CLI {
class App;
}

namespace lightwell {

void add_environment_options(CLI::App& app, EnvironmentChoice& choice);

}  // namespace lightwell
