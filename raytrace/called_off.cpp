#include "raytrace/called_off.h"

#include <tbb/task_group.h>

#include "raytrace/propagation.h"

namespace asdic {

bool called_off() noexcept { return tbb::is_current_task_group_canceling(); }

void leave_if_called_off() {
  if (called_off()) throw Interrupted();
}

}  // namespace asdic
