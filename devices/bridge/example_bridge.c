/* SPDX-License-Identifier: Apache-2.0 */
/* A complete bridge in C for a simulated device, so no hardware is needed. Its handle moves slowly on a
 * circle and yields to the force like a soft spring. To write your own bridge, replace readHandle() and
 * drive() and keep the rest. In this folder of a clone (an installed header needs no -I):
 * cc -O2 -I../../engine/include -o example_bridge example_bridge.c -lm
 * ./example_bridge /run/user/1000/example.door */
#define _GNU_SOURCE
#include <fathom/device_socket.h>

#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <time.h>
#include <unistd.h>

static volatile sig_atomic_t stopped = 0;
static double give[3]; /* [m] displacement of the simulated handle by the force */

static void onSignal(int number) {
    (void)number;
    stopped = 1;
}

static uint64_t now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (uint64_t)t.tv_sec * 1000000000u + (uint64_t)t.tv_nsec;
}

static void readHandle(double position[3]) {
    const double angle = 0.5 * (double)now() * 1e-9;
    const double path[3] = {0.03 * cos(angle), 0.03 * sin(angle), 0.0};
    for (int i = 0; i < 3; ++i) {
        position[i] = path[i] + give[i];
    }
}

static void drive(const double force[3], double share) {
    for (int i = 0; i < 3; ++i) {
        give[i] += 1e-3 * (share * force[i] - 300.0 * give[i]) / 10.0; /* 300 N/m, 10 N s/m */
    }
}

static int isWrench(const struct fathom_door_wrench* wrench, ssize_t size) {
    return size == (ssize_t)sizeof *wrench && wrench->header.magic == FATHOM_DOOR_MAGIC &&
           wrench->header.version == FATHOM_DOOR_VERSION && wrench->header.kind == FATHOM_DOOR_WRENCH &&
           wrench->header.size == sizeof *wrench && !(wrench->flags & FATHOM_DOOR_LAST) &&
           isfinite(wrench->force[0] + wrench->force[1] + wrench->force[2]);
}

static void exchange(int engine) {
    struct fathom_door_hand hand = {
        {FATHOM_DOOR_MAGIC, FATHOM_DOOR_VERSION, FATHOM_DOOR_HAND, sizeof hand, 0, 0, 0},
        0,
        FATHOM_DOOR_PRESENT | FATHOM_DOOR_HOMED,
        0,
        {0, 0, 0},
        {1, 0, 0, 0},
        "falcon",
        "example bridge"};
    struct fathom_door_wrench wrench;
    double force[3] = {0, 0, 0};
    uint64_t heard = 0, since = 0; /* [ns] newest wrench; first wrench after the last silence */
    for (;;) {
        ssize_t got; /* the extra byte in `bytes` detects packets that are too long */
        char bytes[sizeof wrench + 1];
        while ((got = recv(engine, bytes, sizeof bytes, MSG_DONTWAIT)) > 0) {
            memcpy(&wrench, bytes, sizeof wrench);
            if (!isWrench(&wrench, got)) {
                return;
            }
            const uint64_t stamp = wrench.header.time_ns; /* a queued packet may be old */
            since = stamp - heard > FATHOM_DOOR_SILENCE_NS ? stamp : since;
            heard = stamp;
            hand.wrench_sequence = wrench.header.sequence;
            memcpy(force, wrench.force, sizeof force);
        }
        const double back = (double)(now() - since) / 1e8; /* forces fade in over 0.1 s */
        const int silent = heard == 0 || now() - heard > FATHOM_DOOR_SILENCE_NS;
        drive(force, silent ? 0.0 : back < 1.0 ? back : 1.0);
        if (got == 0 || stopped) {
            return; /* the engine closed its end */
        }
        readHandle(hand.position);
        hand.header.sequence++;
        hand.header.time_ns = now();
        send(engine, &hand, sizeof hand, MSG_DONTWAIT | MSG_NOSIGNAL);
        usleep(1000);
    }
}

int main(int argc, char** argv) {
    struct sockaddr_un address = {AF_UNIX, {0}};
    if (argc != 2 || strlen(argv[1]) >= sizeof address.sun_path) {
        fprintf(stderr, "usage: example_bridge SOCKET\n");
        return 2;
    }
    struct sigaction action = {0};
    action.sa_handler = onSignal;                              /* no SA_RESTART: accept() returns */
    const int stopping[] = {SIGINT, SIGTERM, SIGQUIT, SIGHUP}; /* SIGHUP: terminal closed */
    for (size_t i = 0; i < sizeof stopping / sizeof *stopping; ++i) {
        sigaction(stopping[i], &action, NULL);
    }
    signal(SIGPIPE, SIG_IGN); /* a closed output must not end the program with a force on */
    strcpy(address.sun_path, argv[1]);
    const int endpoint = socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0);
    unlink(argv[1]); /* no client can connect before listen(), so chmod comes first */
    if (bind(endpoint, (struct sockaddr*)&address, sizeof address) != 0 || chmod(argv[1], 0600) != 0 ||
        listen(endpoint, 1) != 0) {
        perror(argv[1]);
        return 1;
    }
    while (!stopped) {
        const int engine = accept(endpoint, NULL, NULL);
        if (engine >= 0) {
            exchange(engine);
            drive((double[3]){0, 0, 0}, 0.0);
            close(engine);
        }
    }
    unlink(argv[1]);
    return 0;
}
