/* SPDX-License-Identifier: Apache-2.0 */
/* A system in C99 that stands still: the least that a library must do. Its settings file holds the
 * words for what it is to do wrong; unknown words have no effect. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <modelhouse/system.h>

#ifndef TINY_VERSION
#define TINY_VERSION MH_SYSTEM_VERSION
#endif
#ifndef TINY_MAKE
#define TINY_MAKE mh_make_system
MH_EXPORT
#endif
mh_system* TINY_MAKE(const mh_setup* setup);

typedef struct tiny {
  mh_system system;
  char* message;
  char words[256];
  int64_t stamps_ns[16];
  int32_t seen, queries;
} tiny;

static int told(const tiny* t, const char* word) {
  return strstr(t->words, word) != NULL;
}

static int stand_still(tiny* t, mh_reply* reply) {
  if (told(t, "lost")) return 0;
  reply->map_reset = told(t, "anew");
  reply->has_pose = 1;
  reply->pose.values[0] = told(t, "nan") ? NAN : told(t, "far") ? -1e9 : t->seen;
  reply->pose.values[6] = told(t, "norm") ? 2 : 1;
  return 0;
}

static int track(void* self, const mh_frame* frame, mh_reply* reply) {
  tiny* t = self;
  if (told(t, "crash")) abort();
  if (told(t, "exit")) exit(0);
  if (told(t, "sleep")) sleep(5);
  if (told(t, "print")) puts("0.5\n~nonsense");
  if (told(t, "error")) {
    snprintf(t->message, MH_MESSAGE_SIZE, "no memory\nleft");
    return 7;
  }
  if (told(t, "speechless")) return 7;
  t->stamps_ns[t->seen++ % 16] = frame->stamp_ns;
  reply->keypoints = frame->color[0] + 1000 * frame->depth[0];
  if (frame->laser_count == 1) /* the name's first letter, the last range */
    reply->keypoints =
        frame->lasers[0].name[0] +
        (int32_t)(1000 * frame->lasers[0].ranges_m[frame->lasers[0].range_count - 1] +
                  10 * frame->lasers[0].camera_from_laser.values[1] + frame->lasers[0].max_range_m);
  reply->inliers = told(t, "count") ? -2 : frame->labels != NULL ? frame->labels[0] : MH_UNKNOWN;
  reply->keyframe_added = t->seen == 1 && !told(t, "lost");
  return stand_still(t, reply);
}

static int rewind_feed(void* self) {
  (void)self;
  return 0;
}

static int reset(void* self) {
  ((tiny*)self)->seen = 0;
  return 0;
}

static int freeze(void* self) {
  (void)self;
  return 0;
}

static int trajectory(void* self, mh_add_pose add, void* to) {
  tiny* t = self;
  mh_pose pose = {{4, 0, 0, 0, 0, 0, 1}};
  int32_t i;
  for (i = 0; i < t->seen; ++i) add(to, t->stamps_ns[i], &pose);
  if (told(t, "twice")) add(to, t->stamps_ns[0], &pose);
  if (told(t, "unseen")) add(to, 99, &pose);
  return 0;
}

static int begin_query(void* self) {
  ++((tiny*)self)->queries;
  return 0;
}

static int relocalize(void* self, const mh_frame* frame, mh_reply* reply) {
  tiny* t = self;
  (void)frame;
  reply->stage = told(t, "stage")  ? MH_STAGE_PNP
                 : told(t, "lost") ? MH_STAGE_NO_CANDIDATE
                                   : MH_STAGE_VERIFIED;
  reply->keyframes = 1;
  reply->final = told(t, "candidates") ? 2 : 1;
  reply->inliers = t->queries;
  return stand_still(t, reply);
}

static void destroy(void* self) {
  if (told(self, "print")) puts("goodbye");
  free(self);
}

mh_system* TINY_MAKE(const mh_setup* setup) {
  tiny* t = calloc(1, sizeof(tiny));
  FILE* settings = setup->settings != NULL ? fopen(setup->settings, "r") : NULL;
  if (settings != NULL) {
    if (fgets(t->words, sizeof(t->words), settings) == NULL) t->words[0] = '\0';
    fclose(settings);
  }
  if (told(t, "null")) {
    snprintf(setup->message, MH_MESSAGE_SIZE, "no vocabulary for %d classes", setup->class_count);
    free(t);
    return NULL;
  }
  t->message = setup->message;
  t->system.version = TINY_VERSION;
  t->system.self = t;
  t->system.track = track;
  t->system.rewind = rewind_feed;
  t->system.reset = reset;
  t->system.freeze = freeze;
  if (told(t, "trajectory")) t->system.trajectory = trajectory;
  t->system.begin_query = begin_query;
  if (!told(t, "empty")) t->system.relocalize = relocalize;
  t->system.destroy = destroy;
  return &t->system;
}
