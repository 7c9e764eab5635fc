/// The PID of the paper's task in plain C: what a controller in any language computes.
///
///   W = I (a + 3 w² e + q + 3 w d) - F,   q' = w³ e + w I⁻¹ (limited W - W),   d' = N w (e' - d)
///
/// with e the error of pose (position, rotation vector), e' that of the twist, a the set point's
/// acceleration, I the rod's inertia, F the measured wrench of the tip, w the natural frequency
/// and N = 10. All three poles of the bare rod lie at -w; what the limits cut off bleeds the
/// integral. It is the law of the built-in PID with its default gains.
#pragma once

#include <math.h>
#include <string.h>

#include "fingertip_controller.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct pid_law {
  fingertip_task task;
  double inverse[36];   /* of the inertia, by rows */
  double omega;         /* natural frequency [rad/s] */
  double filter;        /* what a sample adds of the new error to the low-passed one */
  double integral[6];   /* of w³ e, an acceleration */
  double derivative[6]; /* of e, low-passed */
  int started;
} pid_law;

/// Inverse of a 6 x 6 matrix by Gauss-Jordan elimination with row pivoting; 0 if it has none.
static inline int pid_invert(const double* matrix, double* inverse) {
  double a[6][12];
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      a[i][j] = matrix[6 * i + j];
      a[i][6 + j] = i == j ? 1.0 : 0.0;
    }
  for (int k = 0; k < 6; ++k) {
    int pivot = k;
    for (int i = k + 1; i < 6; ++i)
      if (fabs(a[i][k]) > fabs(a[pivot][k])) pivot = i;
    const double divisor = a[pivot][k];
    if (!(fabs(divisor) > 0.0)) return 0;
    for (int j = 0; j < 12; ++j) {
      const double above = a[k][j];
      a[k][j] = a[pivot][j] / divisor;
      if (pivot != k) a[pivot][j] = above;
    }
    for (int i = 0; i < 6; ++i) {
      const double factor = a[i][k];
      for (int j = 0; i != k && j < 12; ++j) a[i][j] -= factor * a[k][j];
    }
  }
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) inverse[6 * i + j] = a[i][6 + j];
  return 1;
}

static inline void pid_multiply(const double* matrix, const double* vector, double* product) {
  for (int i = 0; i < 6; ++i) {
    product[i] = 0.0;
    for (int j = 0; j < 6; ++j) product[i] += matrix[6 * i + j] * vector[j];
  }
}

/// The rotation vector that leads from orientation b to orientation a.
static inline void pid_turn(const double* a, const double* b, double* turn) {
  const double w = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
  const double v[3] = {-a[0] * b[1] + a[1] * b[0] - a[2] * b[3] + a[3] * b[2],
                       -a[0] * b[2] + a[1] * b[3] + a[2] * b[0] - a[3] * b[1],
                       -a[0] * b[3] - a[1] * b[2] + a[2] * b[1] + a[3] * b[0]};
  const double sine = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  const double factor = sine > 0.0 ? 2.0 * atan2(sine, fabs(w)) / sine : 0.0;
  for (int i = 0; i < 3; ++i) turn[i] = (w < 0.0 ? -factor : factor) * v[i];
}

static inline void pid_reset(pid_law* pid) {
  memset(pid->integral, 0, sizeof pid->integral);
  memset(pid->derivative, 0, sizeof pid->derivative);
  pid->started = 0;
}

/// 0 for an inertia that is none.
static inline int pid_start(pid_law* pid, const fingertip_task* task) {
  const double frequency = 60.0, derivative_filter = 10.0; /* [Hz], [1] */
  memset(pid, 0, sizeof *pid);
  pid->task = *task;
  pid->omega = 2.0 * 3.14159265358979323846 * frequency;
  pid->filter = 1.0 - exp(-derivative_filter * pid->omega * task->period);
  return pid_invert(task->inertia, pid->inverse);
}

/// The wrench that leads the endpoint along the set point.
static inline void pid_follow(pid_law* pid, const fingertip_measurement* m,
                              fingertip_wrench* answer) {
  const fingertip_target* set_point = &m->set_point;
  const double w = pid->omega;
  double error[6], rate[6], acceleration[6], wanted[6], excess[6], braking[6];
  pid_turn(set_point->pose.orientation, m->pose.orientation, error + 3);
  for (int i = 0; i < 3; ++i) {
    error[i] = set_point->pose.position[i] - m->pose.position[i];
    rate[i] = set_point->twist.velocity[i] - m->twist.velocity[i];
    rate[3 + i] = set_point->twist.angular_velocity[i] - m->twist.angular_velocity[i];
    acceleration[i] = set_point->acceleration.velocity[i];
    acceleration[3 + i] = set_point->acceleration.angular_velocity[i];
  }
  for (int i = 0; i < 6; ++i) {
    pid->derivative[i] += (pid->started ? pid->filter : 1.0) * (rate[i] - pid->derivative[i]);
    acceleration[i] += 3.0 * w * w * error[i] + pid->integral[i] + 3.0 * w * pid->derivative[i];
  }
  pid->started = 1;
  pid_multiply(pid->task.inertia, acceleration, wanted);
  for (int i = 0; i < 6; ++i) {
    const double limit = i < 3 ? pid->task.force_limit : pid->task.torque_limit;
    wanted[i] -= i < 3 ? m->wrench.force[i] : m->wrench.torque[i - 3];
    const double limited = fmax(-limit, fmin(limit, wanted[i]));
    excess[i] = limited - wanted[i];
    if (i < 3) answer->force[i] = limited;
    if (i >= 3) answer->torque[i - 3] = limited;
  }
  pid_multiply(pid->inverse, excess, braking);
  for (int i = 0; i < 6; ++i)
    pid->integral[i] += pid->task.period * (w * w * w * error[i] + w * braking[i]);
}

#ifdef __cplusplus
}
#endif
