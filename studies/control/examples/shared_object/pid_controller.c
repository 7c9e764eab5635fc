/* The paper's task as a shared object: approach, touch and press, at constant speed and
   orientation. Built without anything of fingertip but one header:

     cmake -S studies/control/examples/shared_object -B /tmp/pid && cmake --build /tmp/pid
     fingertip press --set controller.type=library --set controller.library=/tmp/pid/libpid.so */
#include <stdlib.h>

#include "pid_law.h"

static const char* complaint = NULL;

uint32_t fingertip_controller_abi(void) {
  return FINGERTIP_CONTROLLER_ABI;
}

int32_t fingertip_controller_create(const fingertip_task* task, void** self) {
  pid_law* pid = malloc(sizeof *pid);
  if (pid == NULL || !pid_start(pid, task)) {
    complaint = pid == NULL ? "no memory" : "the inertia has no inverse";
    free(pid);
    return 1;
  }
  *self = pid;
  return FINGERTIP_OK;
}

int32_t fingertip_controller_command(void* self, const fingertip_measurement* measurement,
                                     fingertip_command* command) {
  if (!measurement->has_set_point) {
    complaint = "there is no way to follow in this task";
    return 2;
  }
  command->kind = FINGERTIP_COMMAND_WRENCH;
  pid_follow(self, measurement, &command->wrench);
  return FINGERTIP_OK;
}

int32_t fingertip_controller_reset(void* self) {
  pid_reset(self);
  return FINGERTIP_OK;
}

void fingertip_controller_destroy(void* self) {
  free(self);
}

const char* fingertip_controller_error(void* self) {
  (void)self;
  return complaint;
}
