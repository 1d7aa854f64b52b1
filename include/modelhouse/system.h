/* SPDX-License-Identifier: Apache-2.0 */
/* A SLAM system as a shared library (docs/outside_systems.md, "Library"), loaded by a separate
 * process next to the bench. C99 and C++; this header is self-contained, so a copy of it is all you
 * need.
 *
 * The library defines mh_make_system(). A suite names the library:
 *   systems:
 *   - {name: mine, library: build/libmine.so, settings: mine.yaml}
 *
 * Calls come one at a time, all from one thread. Before a call returns, finish all work that its
 * reply or a later one depends on. The same calls must give the same replies: take randomness only
 * from the seeds, and let no reply depend on a clock.
 *
 * A function that returns a status returns 0 on success. Any other value fails the run: write one
 * line to mh_setup.message before returning it. After that, no function of the system is called
 * again, not even destroy(). Do not let a C++ exception escape from a function.
 */
#ifndef MODELHOUSE_SYSTEM_H
#define MODELHOUSE_SYSTEM_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Version of this interface. A different number means a different layout and is refused. */
#define MH_SYSTEM_VERSION 1

/** Size of mh_setup.message in characters, including the terminating zero. */
#define MH_MESSAGE_SIZE 256

/** A count that is not reported. */
#define MH_UNKNOWN (-1)

/** A pinhole camera. Pixel centers have integer coordinates. */
typedef struct mh_camera {
  int32_t width_px, height_px;
  double fx_px, fy_px, cx_px, cy_px;
  double k1, k2, p1, p2, k3; /**< distortion as in OpenCV */
  double rate_hz;            /**< frames per second */
  double baseline_m;         /**< between the camera and the depth sensor's projector */
  double depth_per_meter;    /**< value of a depth pixel at 1 m */
} mh_camera;

/** What a system is created from. Pointers stay valid until the system is destroyed. */
typedef struct mh_setup {
  uint32_t version; /**< MH_SYSTEM_VERSION of the bench */
  mh_camera camera;
  uint64_t seed;        /**< of the trial */
  const char* settings; /**< absolute path of the `settings` of this system's entry in the suite;
                           NULL = none */
  int32_t class_count;
  const char* const* classes; /**< name of each class id; 0 is void (unknown) */
  char* message;              /**< MH_MESSAGE_SIZE characters: why a function failed */
  double k4, k5, k6; /**< rest of the camera's distortion, as in OpenCV; 0 with five coefficients */
} mh_setup;

/** A registered frame: a given pixel shows the same point in all images. Rows are stored from top
 * to bottom without padding. The bench owns it; it is valid until the function returns. */
typedef struct mh_frame {
  int64_t stamp_ns;
  int32_t width_px, height_px;
  const uint8_t* color;  /**< red, green, blue: 3 per pixel */
  const uint16_t* depth; /**< along the optical axis, see depth_per_meter; 0 = no return */
  const uint8_t* labels; /**< class id per pixel; NULL if the run has no labels */
  int32_t seed;          /**< seeds all randomness of this call, >= 0; each attempt has its own */
  /* New members come last, so that a library that was built before them still works. */
  /** Camera pose by wheel odometry alone, in a world that drifts. NULL: no odometry. */
  const struct mh_pose* odometry;
  /** What the inertial sensor delivered since the previous frame (after rewind(): since the frame
   * that precedes this one in the sequence), in order. */
  const struct mh_imu* imu;
  int32_t imu_count; /**< 0: none */
  /** What the robot's lasers measure at the stamp; given in queries, too. */
  const struct mh_laser* lasers;
  int32_t laser_count; /**< 0: none */
} mh_frame;

/** Pose of the camera in the system's own world (world_from_camera): x y z in meters, then the unit
 * quaternion qx qy qz qw. Camera axes: x right, y down, z forward. The world must stay the same
 * until reset() or map_reset. */
typedef struct mh_pose {
  double values[7];
} mh_pose;

/** A reading of an inertial sensor in the camera's housing, in the camera's axes. */
typedef struct mh_imu {
  int64_t stamp_ns;
  double turn_rad_per_s[3];
  double specific_force_m_per_s2[3]; /**< at rest 9.81 upward */
} mh_imu;

/** A planar scan: ray k leaves the laser along its x axis, turned about z by first_rad + k *
 * step_rad. */
typedef struct mh_laser {
  const char* name;
  mh_pose camera_from_laser; /**< laser to camera, at the stamp */
  double first_rad, step_rad;
  double min_range_m, max_range_m;
  const float* ranges_m; /**< range_count numbers; 0 = nothing in range */
  int32_t range_count;
} mh_laser;

/** Where a relocalization ended. */
typedef enum mh_stage {
  MH_STAGE_UNKNOWN = 0,
  MH_STAGE_NO_CANDIDATE = 1, /**< no keyframe looked similar */
  MH_STAGE_MATCHES = 2,      /**< too few matches */
  MH_STAGE_PNP = 3,          /**< no pose */
  MH_STAGE_INLIERS = 4,      /**< a pose with too few inliers */
  MH_STAGE_VERIFIED = 5      /**< found; the only stage with a pose */
} mh_stage;

/** What a system reports about a frame. The bench initializes it to "lost, nothing known": fill in
 * what you know. */
typedef struct mh_reply {
  int32_t has_pose; /**< 0: the system is lost */
  mh_pose pose;
  int32_t keypoints, inliers; /**< or MH_UNKNOWN, like all counts here */
  int32_t keyframe_added;     /**< nonzero: the frame became a keyframe; its depth is added to the
                                   occupancy map */
  int32_t map_reset;          /**< nonzero: the system discarded its map and started a new one with
                                   this frame; its earlier poses are invalid */
  int32_t stage;              /**< an mh_stage */
  /** Relocalization: keyframes in the map, and how many remain after each step of Algorithm 1. */
  int32_t keyframes, c1, c2, c3, final;
} mh_reply;

/** Callback that receives one pose of the finished map. */
typedef void (*mh_add_pose)(void* to, int64_t stamp_ns, const mh_pose* pose);

/** A system: its functions and the object that is passed to each as `self`. A function pointer may
 * be NULL only where stated. */
typedef struct mh_system {
  uint32_t version; /**< MH_SYSTEM_VERSION of the library */
  void* self;

  /** Processes the next frame, mapping included. */
  int (*track)(void* self, const mh_frame* frame, mh_reply* reply);
  /** The input jumps back in time: treat tracking as lost, keep the map. */
  int (*rewind)(void* self);
  /** Forgets everything, including the map. */
  int (*reset)(void* self);
  /** Mapping is over: from now on the map must not change. Queries follow; no function above is
   * called again. */
  int (*freeze)(void* self);
  /** Called once after freeze(): passes each tracked frame once to `add`, with its pose in the
   * finished map, in any order. If NULL, the last reply to each frame is used instead. */
  int (*trajectory)(void* self, mh_add_pose add, void* to);

  /** Begins a query, which must not depend on the one before it: start with tracking lost and the
   * frozen map. May be NULL if the system keeps no state between queries. */
  int (*begin_query)(void* self);
  /** Processes a black frame without depth, as from a covered camera. If NULL, tracking counts as
   * lost at once. */
  int (*blank)(void* self, const mh_frame* frame, mh_reply* reply);
  /** Relocalizes a frame in the frozen map. */
  int (*relocalize)(void* self, const mh_frame* frame, mh_reply* reply);

  /** Destroys the system: the last call. It may free the mh_system itself, too. */
  void (*destroy)(void* self);
} mh_system;

#if defined(__GNUC__)
#define MH_EXPORT __attribute__((visibility("default")))
#else
#define MH_EXPORT
#endif

/** Creates a system with an empty map; NULL on failure, see mh_setup.message. */
MH_EXPORT mh_system* mh_make_system(const mh_setup* setup);

#ifdef __cplusplus
}
#endif

#endif
