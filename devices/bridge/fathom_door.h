/* SPDX-License-Identifier: Apache-2.0 */
/* The door: how a program that owns a haptic device (a bridge) and Fathom's engine talk, and how an observer
 * listens. Plain C, no library needed; devices/bridge/example_bridge.c is a whole bridge, README.md beside it
 * says it in words. Rules:
 * - A local socket, AF_UNIX SOCK_SEQPACKET: one send is one packet is one struct below, never more or less.
 *   Both ends run on one machine, so numbers are in its own byte order. Who may connect is the socket file's
 *   permission (0600 unless its owner opens it), nothing else.
 * - HAND DOOR: the bridge listens, the engine connects. The bridge sends fathom_door_hand whenever the device
 *   has a new sample, at least every 5 ms; the engine sends fathom_door_wrench once a tick.
 * - Zero force without being told: when the engine's end closes, when nothing came for FATHOM_DOOR_SILENCE_NS
 *   or its newest packet is older than that by its stamp, and until the first one. After a silence forces
 * should come back over some 0.1 s, not at once.
 * - The engine does likewise: a bridge that is silent or gone is an open dead-man switch, then a clutch: the
 *   tool stays where it is.
 * - A packet of another size, magic, version or kind ends the connection; nothing in it is used.
 * - VIEW DOOR: the engine listens, observers connect (up to four) and only receive: fathom_door_state once a
 *   tick, fathom_door_regions and fathom_door_fixtures as many as a fixture set needs. An observer that does
 *   not keep up loses packets (see `sequence`), the engine never waits. */
#pragma once

#include <stdint.h>

#define FATHOM_DOOR_MAGIC 0x524f4f44u /* "DOOR" in memory */
#define FATHOM_DOOR_VERSION 1
#define FATHOM_DOOR_SILENCE_NS 10000000 /* 10 ms */

/* fathom_door_header.kind */
#define FATHOM_DOOR_HAND 1
#define FATHOM_DOOR_WRENCH 2
#define FATHOM_DOOR_STATE 3
#define FATHOM_DOOR_REGIONS 4
#define FATHOM_DOOR_FIXTURES 5

/* fathom_door_hand.status: a sample moves the tool only when both are set */
#define FATHOM_DOOR_PRESENT 1u /* the device answers */
#define FATHOM_DOOR_HOMED 2u   /* its position is absolute */

/* fathom_door_hand.buttons, by level */
#define FATHOM_DOOR_GUIDANCE 1u
#define FATHOM_DOOR_DEAD_MAN_OPEN 2u
#define FATHOM_DOOR_CLUTCH 4u

/* fathom_door_wrench.flags */
#define FATHOM_DOOR_FORCES_ON 1u /* not set: the wrench is zero on purpose */
#define FATHOM_DOOR_LAST 2u      /* the engine is about to close */

/* Begins every packet, either way. */
struct fathom_door_header {
    uint32_t magic;
    uint16_t version;
    uint16_t kind;
    uint32_t size; /* bytes, header included: sizeof of the struct of that kind */
    uint32_t reserved;
    uint64_t sequence; /* of this direction, from 1, by one a packet */
    uint64_t time_ns;  /* CLOCK_MONOTONIC when the content was measured or computed */
};

/* Bridge to engine. Device frame: any right-handed one, the scene's hand.map turns it. */
struct fathom_door_hand {
    struct fathom_door_header header;
    uint64_t wrench_sequence; /* of the newest wrench received; 0 = none */
    uint32_t status;
    uint32_t buttons;
    double position[3];    /* [m] of the handle */
    double orientation[4]; /* w x y z; 1 0 0 0 when the device does not sense it */
    char preset[16];       /* row of Fathom's device presets ("falcon"), zero-terminated */
    char name[32];         /* for people, zero-terminated */
};

/* Engine to bridge, once a tick. */
struct fathom_door_wrench {
    struct fathom_door_header header;
    uint64_t hand_sequence; /* of the sample it answers; 0 = none */
    uint32_t flags;
    uint32_t reserved;
    double force[3];  /* [N] on the hand, device frame, on the preset's actuated axes only */
    double torque[3]; /* [N m] about the handle, device frame */
};

/* Engine to observers, once a tick. Poses are of the frame named last in the frame named first. */
struct fathom_door_state {
    struct fathom_door_header header;
    double t; /* [s] since the run's start */
    double base_T_hand_position[3], base_T_hand_orientation[4];
    double base_T_tool_position[3], base_T_tool_orientation[4];
    double force[3], torque[3]; /* on the hand, base axes, before projection on the device's axes */
    double min_gap;             /* [m]; NaN = not known */
    double scene_age;           /* [s]; NaN = not known */
    double guidance;            /* 0..1 how far guidance has eased in */
    int64_t frame;              /* picture obeyed; -1 = none */
    uint64_t generation;        /* fixture set obeyed: its regions carry the same number; 0 = none */
    uint32_t contacts;          /* rows that push */
    uint32_t state;             /* 0 off, 1 free, 2 contact, 3 escape, 4 trapped, 5 fading */
};

/* One region sphere. */
struct fathom_door_sphere {
    float x, y, z, radius; /* [m], base axes, about fathom_door_regions.origin */
    uint32_t fixture;      /* row of the scene's fixtures */
};

#define FATHOM_DOOR_SPHERES 256

/* Engine to observers, for each new fixture set: its region spheres in parts. */
struct fathom_door_regions {
    struct fathom_door_header header;
    int64_t frame;
    uint64_t generation;
    double origin[3]; /* [m] base frame */
    uint32_t total;   /* spheres of the set */
    uint32_t first;   /* index of spheres[0] in the set */
    uint32_t count;   /* that are filled here, 0..FATHOM_DOOR_SPHERES */
    uint32_t reserved;
    struct fathom_door_sphere spheres[FATHOM_DOOR_SPHERES];
};

/* fathom_door_fixture.kind; all but the first are shapes that a person placed */
#define FATHOM_DOOR_TARGET 0u   /* where guidance of a class pulls the tool: base_T_tool */
#define FATHOM_DOOR_SPHERE 1u   /* size[0]: radius */
#define FATHOM_DOOR_BOX 2u      /* size: edges, about the pose's position */
#define FATHOM_DOOR_PLANE 3u    /* the half-space below the pose's z = 0 */
#define FATHOM_DOOR_CYLINDER 4u /* along the pose's z; size[0]: radius, size[1]: length */
#define FATHOM_DOOR_LINE 5u     /* the tool slides on the pose's z */
#define FATHOM_DOOR_AXIS 6u     /* the same, the tool's z along it */

/* fathom_door_fixture.flags */
#define FATHOM_DOOR_SEEN 1u    /* a target: enough of its points are in the picture */
#define FATHOM_DOOR_KEEP_IN 2u /* a shape: the tool stays inside, not outside */

/* One target or shape: what its numbers mean is said with its kind. */
struct fathom_door_fixture {
    uint32_t fixture; /* row of the scene's fixtures */
    uint32_t kind, flags;
    uint32_t points;           /* of the picture behind a target */
    double base_T_position[3]; /* [m] */
    double base_T_orientation[4];
    double size[3]; /* [m] */
};

#define FATHOM_DOOR_ROWS 32

/* Engine to observers, for each new fixture set and each change of a shape: what is in force besides region
 * spheres, in parts. */
struct fathom_door_fixtures {
    struct fathom_door_header header;
    int64_t frame;
    uint64_t generation;
    uint32_t total; /* targets and shapes */
    uint32_t first; /* index of rows[0] among them */
    uint32_t count; /* that are filled here, 0..FATHOM_DOOR_ROWS */
    uint32_t reserved;
    struct fathom_door_fixture rows[FATHOM_DOOR_ROWS];
};
