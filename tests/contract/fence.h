/* A run behind a fence: a child process gives up all system calls but read, write and exit (seccomp, strict mode: the
 * kernel kills at any other). Left out under a sanitizer or a checker, whose own calls would be the ones that are
 * caught: these are known at build time, or by an empty child that does not come through. The program defines
 * `outcome`, a struct of numbers, and `outcome all_deeds(void)` before it includes this, and _GNU_SOURCE at its top. */
#ifndef DMB_TESTS_FENCE_H
#define DMB_TESTS_FENCE_H

#include <fcntl.h>
#include <stdio.h>
#include <sys/wait.h>
#include <unistd.h>

#include "sanitized.h"

#if defined(__linux__) && !defined(SANITIZED)
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#define FENCED 1
#endif

#if defined(FENCED)
enum { EMPTY, RUNS, OPENS_A_FILE };

static void child(int task, int out)
{
    outcome o = {0};
    if (prctl(PR_SET_SECCOMP, SECCOMP_MODE_STRICT) != 0) (void)syscall(SYS_exit, 3);
    if (task == RUNS) o = all_deeds();
    if (task == OPENS_A_FILE) (void)open("/dev/null", O_RDONLY);
    (void)syscall(SYS_exit, write(out, &o, sizeof o) == (ssize_t)sizeof o ? 0 : 4);
}

/* Wait status of a child that does the task behind the fence. */
static int behind_the_fence(int task, outcome *o)
{
    int ends[2], status = -1;
    pid_t pid;
    memset(o, 0, sizeof *o);
    assert_int_equal(pipe(ends), 0);
    fflush(NULL);
    pid = fork();
    assert_true(pid >= 0);
    if (pid == 0) child(task, ends[1]);
    close(ends[1]);
    (void)!read(ends[0], o, sizeof *o);
    close(ends[0]);
    assert_int_equal(waitpid(pid, &status, 0), pid);
    return status;
}

static int comes_through(int task)
{
    outcome o;
    const int status = behind_the_fence(task, &o);
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

static int fence_works(void)
{
    return comes_through(EMPTY) && !comes_through(OPENS_A_FILE);
}

static outcome run_behind_the_fence(void)
{
    outcome o;
    const int status = behind_the_fence(RUNS, &o);
    if (WIFSIGNALED(status)) fail_msg("the kernel ended the run with signal %d: a system call", WTERMSIG(status));
    assert_int_equal(WEXITSTATUS(status), 0);
    return o;
}
#else
static int fence_works(void)
{
    return 0;
}

static outcome run_behind_the_fence(void)
{
    return all_deeds();
}
#endif

#endif
