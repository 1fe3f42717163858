/* SPDX-License-Identifier: Apache-2.0 */
/** @file
 * Protocol of the Fathom sockets ("doors"): how a bridge, a program that drives a haptic device, exchanges
 * data with Fathom's engine, and how an observer receives the engine's state. Plain C, no library needed.
 * devices/bridge/example_bridge.c is a complete bridge; README.md next to it explains the protocol.
 * - Transport: a local AF_UNIX SOCK_SEQPACKET socket. Each packet is exactly one struct below. Both ends run
 *   on one machine, so numbers are in native byte order. Only the permissions of the socket file control
 *   access (0600 unless its owner changes them).
 * - Hand socket (HAND, WRENCH): the bridge listens, the engine connects. The bridge sends fathom_door_hand
 *   for every new sample, at least every 5 ms. The engine sends fathom_door_wrench once per tick.
 * - Safety of the bridge: it must apply zero force before the first wrench, when the engine's end closes,
 *   when no packet arrived for FATHOM_DOOR_SILENCE_NS, and when the newest packet's time_ns is older than
 *   that. After a silence, raise forces over about 0.1 s, in addition to the engine's own rise of
 *   0.2 s after a loss.
 * - Safety of the engine: it treats a silent or missing bridge as an open dead-man switch and then as a
 *   clutch, so the tool stays where it is.
 * - A packet with a wrong size, magic, version or kind ends the connection; its content is not used. A
 *   sample whose numbers are not finite, or whose time_ns is more than FATHOM_DOOR_SILENCE_NS ago, counts as
 *   absent. The engine's log names the cause of both.
 * - View socket (STATE, REGIONS, FIXTURES): the engine listens, up to four observers connect and only
 *   receive: fathom_door_state once per tick, and as many fathom_door_regions and fathom_door_fixtures as a
 *   fixture set needs. The engine never waits.
 * - Observers: the parts of a set arrive complete and in order, from `first` = 0 up to `total`, between
 *   states and over several ticks if needed. A slow observer skips whole sets: after one that has begun, the
 *   newest follows. An unchanged set is sent once. Only states are lost when an observer does not read; each
 *   is a gap in `sequence`. */
#pragma once

#include <stdint.h>

#define FATHOM_DOOR_MAGIC 0x524f4f44u   /**< "DOOR" in memory */
#define FATHOM_DOOR_VERSION 1           /**< fathom_door_header.version */
#define FATHOM_DOOR_SILENCE_NS 10000000 /**< 10 ms */

/* fathom_door_header.kind */
#define FATHOM_DOOR_HAND 1     /**< fathom_door_hand */
#define FATHOM_DOOR_WRENCH 2   /**< fathom_door_wrench */
#define FATHOM_DOOR_STATE 3    /**< fathom_door_state */
#define FATHOM_DOOR_REGIONS 4  /**< fathom_door_regions */
#define FATHOM_DOOR_FIXTURES 5 /**< fathom_door_fixtures */

/* fathom_door_hand.status: a sample moves the tool only if both bits are set */
#define FATHOM_DOOR_PRESENT 1u /**< the device answers */
#define FATHOM_DOOR_HOMED 2u   /**< its position is absolute */

/* fathom_door_hand.buttons: a bit is 1 while the button is down */
#define FATHOM_DOOR_GUIDANCE 1u      /**< pulls the tool towards the guidance target */
#define FATHOM_DOOR_DEAD_MAN_OPEN 2u /**< no force */
#define FATHOM_DOOR_CLUTCH 4u        /**< moves the hand without the tool */

/* fathom_door_wrench.flags */
#define FATHOM_DOOR_FORCES_ON 1u /**< if not set, the wrench is zero on purpose */
#define FATHOM_DOOR_LAST 2u      /**< the engine is about to close the connection */

/** Start of every packet in both directions. */
struct fathom_door_header {
    uint32_t magic;    /**< FATHOM_DOOR_MAGIC */
    uint16_t version;  /**< FATHOM_DOOR_VERSION */
    uint16_t kind;     /**< of the packet */
    uint32_t size;     /**< [bytes] sizeof the struct of that kind, header included */
    uint32_t reserved; /**< 0 */
    uint64_t sequence; /**< per connection and direction: 1, 2, 3, ... */
    uint64_t time_ns;  /**< CLOCK_MONOTONIC at measurement or computation */
};

/** Bridge to engine. Device frame: any right-handed frame; the scene's hand.map rotates it to base. */
struct fathom_door_hand {
    struct fathom_door_header header; /**< kind HAND */
    uint64_t wrench_sequence;         /**< header.sequence of the newest wrench received; 0 = none */
    uint32_t status;                  /**< PRESENT and HOMED */
    uint32_t buttons;                 /**< GUIDANCE, DEAD_MAN_OPEN and CLUTCH */
    double position[3];               /**< [m] of the handle */
    double orientation[4];            /**< w x y z; 1 0 0 0 when the device does not sense it. Normalised; if
                                           its squared length is not in 0.5 to 2, the sample counts as absent */
    char preset[16];                  /**< row of Fathom's device presets ("falcon"), zero-terminated */
    char name[32];                    /**< shown to the user, zero-terminated */
};

/** Engine to bridge, once per tick. */
struct fathom_door_wrench {
    struct fathom_door_header header; /**< kind WRENCH */
    uint64_t hand_sequence;           /**< header.sequence of the hand sample it answers; 0 = none */
    uint32_t flags;                   /**< FORCES_ON and LAST */
    uint32_t reserved;                /**< 0 */
    double force[3];  /**< [N] on the hand, device frame, on the preset's actuated axes only */
    double torque[3]; /**< [N m] about the handle, device frame */
};

/** Engine to observers, once per tick. A_T_B is the pose of frame B in frame A. */
struct fathom_door_state {
    struct fathom_door_header header;  /**< kind STATE */
    double t;                          /**< [s] since the start of the run */
    double base_T_hand_position[3];    /**< [m] commanded tool pose */
    double base_T_hand_orientation[4]; /**< w x y z */
    double base_T_tool_position[3];    /**< [m] */
    double base_T_tool_orientation[4]; /**< w x y z */
    double force[3];     /**< [N] on the hand, base axes, before projection onto the device's axes */
    double torque[3];    /**< [N m] likewise */
    double min_gap;      /**< [m] of the contact set; its reach if none is nearer; NaN = unknown */
    double scene_age;    /**< [s]; NaN = unknown */
    double guidance;     /**< 0..1 weight of guidance */
    int64_t frame;       /**< camera frame of the active set; -1 = none */
    uint64_t generation; /**< active fixture set, as in fathom_door_regions; 0 = none */
    uint32_t contacts;   /**< active constraint rows, and one more if an exact check blocks the tool */
    uint32_t state;      /**< 0 off, 1 free, 2 contact, 3 escape, 4 trapped, 5 fading, 6 waiting */
};

/** One region sphere. */
struct fathom_door_sphere {
    float x;          /**< [m] base axes, relative to fathom_door_regions.origin */
    float y;          /**< [m] likewise */
    float z;          /**< [m] likewise */
    float radius;     /**< [m] */
    uint32_t fixture; /**< index into the scene's fixtures */
};

#define FATHOM_DOOR_SPHERES 256 /**< most spheres of a packet */

/** Engine to observers, for each new fixture set: its region spheres in parts. */
struct fathom_door_regions {
    struct fathom_door_header header; /**< kind REGIONS */
    int64_t frame;                    /**< camera frame of the set */
    uint64_t generation;              /**< number of the set */
    double origin[3];                 /**< [m] base frame */
    uint32_t total;                   /**< spheres of the set */
    uint32_t first;                   /**< index of spheres[0] in the set */
    uint32_t count;                   /**< spheres in this packet, 0..FATHOM_DOOR_SPHERES */
    uint32_t reserved;                /**< 0 */
    struct fathom_door_sphere spheres[FATHOM_DOOR_SPHERES]; /**< the first `count` are valid */
};

/* fathom_door_fixture.kind. All except TARGET are placed shapes. */
#define FATHOM_DOOR_TARGET 0u   /**< base_T_tool to which a guidance class pulls */
#define FATHOM_DOOR_SPHERE 1u   /**< size[0]: radius */
#define FATHOM_DOOR_BOX 2u      /**< size: edge lengths; centred at the pose */
#define FATHOM_DOOR_PLANE 3u    /**< the half-space below the pose's z = 0 */
#define FATHOM_DOOR_CYLINDER 4u /**< along the pose's z; size[0]: radius, size[1]: length */
#define FATHOM_DOOR_LINE 5u     /**< the tool slides along the pose's z */
#define FATHOM_DOOR_AXIS 6u     /**< same, with the tool's z along it */

/* fathom_door_fixture.flags */
#define FATHOM_DOOR_SEEN 1u    /**< a target: enough of its points are in the frame */
#define FATHOM_DOOR_KEEP_IN 2u /**< a shape: the tool stays inside instead of outside */

/** One target or shape; its kind defines the meaning of the numbers. */
struct fathom_door_fixture {
    uint32_t fixture;             /**< index into the scene's fixtures */
    uint32_t kind;                /**< TARGET .. AXIS */
    uint32_t flags;               /**< SEEN and KEEP_IN */
    uint32_t points;              /**< number of points that define a target */
    double base_T_position[3];    /**< [m] */
    double base_T_orientation[4]; /**< w x y z */
    double size[3];               /**< [m] */
};

#define FATHOM_DOOR_ROWS 32 /**< most rows of a packet */

/** Engine to observers, for each new fixture set and each change of a shape: all targets and active
 * shapes, in parts. */
struct fathom_door_fixtures {
    struct fathom_door_header header;                  /**< kind FIXTURES */
    int64_t frame;                                     /**< camera frame of the set */
    uint64_t generation;                               /**< number of the set */
    uint32_t total;                                    /**< targets and shapes */
    uint32_t first;                                    /**< index of rows[0] among them */
    uint32_t count;                                    /**< rows in this packet, 0..FATHOM_DOOR_ROWS */
    uint32_t reserved;                                 /**< 0 */
    struct fathom_door_fixture rows[FATHOM_DOOR_ROWS]; /**< the first `count` are valid */
};
