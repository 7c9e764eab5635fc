/// The C interface of a controller that fingertip loads at run time (controller.type = "library").
///
/// A shared object exports the functions at the end of this file under these names, with C linkage.
/// Everything is in SI units and in world axes, which are the rod's axes at the start: the tip is
/// pressed toward +z. Quaternions are (w, x, y, z), of length one. The rod is held and measured at
/// its endpoint (0, 0, -rod length). C99 or newer, C++ as well; no other header of fingertip is
/// needed.
#pragma once

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/// Version of everything in this file. It grows with every change; a program and a controller of
/// different versions do not work together, and the program says so.
#define FINGERTIP_CONTROLLER_ABI 2

/// Where the rod is.
typedef struct fingertip_pose {
  double position[3];    /* of the endpoint [m] */
  double orientation[4]; /* since the start: (w, x, y, z), unit length */
} fingertip_pose;

/// How the rod's endpoint moves, or is accelerated [m/s², rad/s²].
typedef struct fingertip_twist {
  double velocity[3];         /* [m/s] */
  double angular_velocity[3]; /* [rad/s] */
} fingertip_twist;

/// A force and a torque about the rod's endpoint.
typedef struct fingertip_wrench {
  double force[3];  /* [N] */
  double torque[3]; /* [N m] */
} fingertip_wrench;

/// Where the endpoint should be and how it should move.
typedef struct fingertip_target {
  fingertip_pose pose;
  fingertip_twist twist;
  fingertip_twist acceleration; /* [m/s², rad/s²] */
} fingertip_target;

/// A sensor in the skin, on the undeformed finger.
typedef struct fingertip_taxel {
  double place[3];  /* in the rod's starting axes [m] */
  double normal[3]; /* unit, out of the rubber */
  double area;      /* of the surface that it stands for [m²] */
} fingertip_taxel;

/// What it feels, in axes of its surface: u, v and the outward normal are x, y, z turned along the
/// shortest way from z to that normal. Of the obstacle on the skin [Pa].
typedef struct fingertip_taxel_reading {
  double normal_stress; /* positive where it is pressed */
  double shear_u;
  double shear_v;
} fingertip_taxel_reading;

/// What a controller knows before its first measurement.
typedef struct fingertip_task {
  uint32_t size;        /* of this struct [bytes] */
  uint32_t abi;         /* FINGERTIP_CONTROLLER_ABI of the program */
  double period;        /* between two commands [s] */
  double inertia[36];   /* of the rod at its endpoint, 6 x 6 by rows: (force, torque) = inertia *
                           (acceleration, angular acceleration) [kg, kg m, kg m²] */
  double force_limit;   /* largest force along each axis [N] */
  double torque_limit;  /* largest torque about each axis [N m] */
  double normal[3];     /* of the plane, unit, from the plane toward the rod */
  double clearance;     /* between tip and plane at the start [m] */
  double depth;         /* wanted indentation [m] */
  double speed;         /* of the approach [m/s] */
  uint64_t taxel_count; /* of the skin (sensor.taxels); 0: there is none */
  const fingertip_taxel* taxels; /* valid during the call only */
} fingertip_task;

/// What the controller gets once per period.
typedef struct fingertip_measurement {
  uint32_t size; /* of this struct [bytes] */
  uint32_t abi;
  double time; /* when it was taken [s] */
  fingertip_pose pose;
  fingertip_twist twist;
  fingertip_wrench wrench;    /* of the tip on the rod */
  int32_t has_contact;        /* 1: there is a tactile sensor, and the next three are known */
  int32_t touching;           /* points of the tip on the plane */
  double contact_radius;      /* [m] */
  fingertip_wrench on_tip;    /* of the plane on the tip, about the rod's endpoint */
  int32_t has_set_point;      /* 1: the task has a way to follow, and set_point is on it */
  int32_t reserved;           /* 0 */
  fingertip_target set_point; /* at `time`: the approach at the task's speed, or its stages */
  uint64_t taxel_count;       /* as in the task */
  const fingertip_taxel_reading* taxels; /* in the task's order; valid during the call only */
} fingertip_measurement;

/// What `fingertip_command.kind` may be.
enum {
  FINGERTIP_COMMAND_WRENCH = 1, /* `wrench` acts at the endpoint */
  FINGERTIP_COMMAND_TARGET = 2  /* the program's own servo leads the endpoint to `target` */
};

/// What the controller wants until the next measurement. The program hands it over with size and
/// abi set and all else zero.
typedef struct fingertip_command {
  uint32_t size; /* of this struct [bytes] */
  uint32_t abi;
  int32_t kind;
  int32_t reserved; /* 0 */
  fingertip_wrench wrench;
  fingertip_target target;
} fingertip_command;

/// What the functions return: 0, or any other number for a failure, which ends the run.
enum { FINGERTIP_OK = 0 };

#if defined(_WIN32)
#define FINGERTIP_EXPORT __declspec(dllexport)
#else
#define FINGERTIP_EXPORT __attribute__((visibility("default")))
#endif

/// FINGERTIP_CONTROLLER_ABI of the header that the controller was compiled with; asked first.
FINGERTIP_EXPORT uint32_t fingertip_controller_abi(void);

/// Makes a controller for `task`, which is valid during the call only, and sets `*self` to
/// whatever the other functions shall get. A failed create() must leave nothing behind.
FINGERTIP_EXPORT int32_t fingertip_controller_create(const fingertip_task* task, void** self);

/// Called once per period, from one thread, with increasing times. The run waits for it.
FINGERTIP_EXPORT int32_t fingertip_controller_command(void* self,
                                                      const fingertip_measurement* measurement,
                                                      fingertip_command* command);

/// Forgets everything since create().
FINGERTIP_EXPORT int32_t fingertip_controller_reset(void* self);

/// Ends what create() has made; called once.
FINGERTIP_EXPORT void fingertip_controller_destroy(void* self);

/// Optional: why the last call with this `self` failed (a null `self` after create()). The text
/// stays valid until the next call. May be null.
FINGERTIP_EXPORT const char* fingertip_controller_error(void* self);

#ifdef __cplusplus
}
#endif
