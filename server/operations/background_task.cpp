#include "server/operations/background_task.h"

#include "server/operations/log.h"

namespace lightwell {

void BackgroundTask::failed(const std::string& reason) {
  metrics_.background_task_failed(name_);
  if (!fails_.exchange(true)) log_event(LogLevel::kError, "task_fails", {{"task", name_}, {"reason", reason}});
}

void BackgroundTask::worked() {
  if (fails_.exchange(false)) log_event(LogLevel::kInfo, "task_works_again", {{"task", name_}});
}

}  // namespace lightwell
