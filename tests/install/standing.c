/* SPDX-License-Identifier: Apache-2.0 */
/* The least system that a suite can name as a library: it reports that it stands still. */
#include <stddef.h>

#include <modelhouse/system.h>

static int reply_origin(void* self, const mh_frame* frame, mh_reply* reply) {
  (void)self;
  (void)frame;
  reply->has_pose = 1;
  reply->pose.values[6] = 1; /* qw */
  return 0;
}

static int do_nothing(void* self) {
  (void)self;
  return 0;
}

static void keep(void* self) {
  (void)self; /* the system is static: there is nothing to free */
}

mh_system* mh_make_system(const mh_setup* setup) {
  static mh_system system;
  (void)setup;
  system.version = MH_SYSTEM_VERSION;
  system.track = reply_origin;
  system.rewind = do_nothing;
  system.reset = do_nothing;
  system.freeze = do_nothing;
  system.relocalize = reply_origin;
  system.destroy = keep;
  return &system;
}
