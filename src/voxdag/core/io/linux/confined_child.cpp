#include "voxdag/core/io/confined_child.hpp"

#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstddef>
#include <fstream>
#include <new>
#include <string>
#include <system_error>
#include <vector>

#include "voxdag/core/error.hpp"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define VOXDAG_SANITIZED 1  // Sanitizers need more memory and system calls of their own.
#endif

namespace voxdag {
namespace {

// Exit codes of the child.
constexpr int kDone = 0, kThrew = 1, kOutOfMemory = 2, kNotConfined = 3;

constexpr std::uint32_t kArchitecture =
#if defined(__x86_64__)
    AUDIT_ARCH_X86_64;
#elif defined(__aarch64__)
    AUDIT_ARCH_AARCH64;
#else
    0;  // No child can be confined.
#endif

/// Lets the calling thread make only the system calls of computing, of taking memory, and of
/// reading and writing what is open. Others fail with EPERM. Returns whether the system agreed.
bool confine_system_calls() {
  if constexpr (kArchitecture == 0) return false;
  std::vector<sock_filter> filter{
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, arch)),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, kArchitecture, 1, 0),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_KILL_PROCESS),
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
  };
  for (const std::uint32_t call : {
         SYS_read, SYS_write, SYS_lseek, SYS_close, SYS_brk, SYS_mmap, SYS_mremap, SYS_munmap,
             SYS_mprotect, SYS_madvise, SYS_futex, SYS_getrandom, SYS_clock_gettime,
             SYS_sched_yield, SYS_rt_sigprocmask, SYS_rt_sigreturn, SYS_exit, SYS_exit_group,
#if VOXDAG_SANITIZED
             SYS_sigaltstack, SYS_pipe2,
#endif
       }) {
    filter.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, call, 0, 1));
    filter.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW));
  }
  filter.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EPERM));
  const sock_fprog program{static_cast<unsigned short>(filter.size()), filter.data()};
  return ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
         ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}

/// Sets a limit. The hard limit is greater, so that SIGXCPU and not SIGKILL tells RLIMIT_CPU.
bool limit(__rlimit_resource resource, std::uint64_t value) {
  const rlimit soft_and_hard{value, value + 1};
  return ::setrlimit(resource, &soft_and_hard) == 0;
}

/// Limits the memory that the process can write to what it has now, and `bytes` more.
bool limit_memory(std::uint64_t bytes) {
#if VOXDAG_SANITIZED
  return bytes > 0;  // Shadow memory is larger than any limit.
#else
  std::ifstream file("/proc/self/statm");  // Pages: size, resident, shared, text, 0, data.
  std::uint64_t pages = 0;
  for (int field = 0; field < 6; ++field) file >> pages;
  return file && limit(RLIMIT_DATA, pages * static_cast<std::uint64_t>(::getpagesize()) + bytes);
#endif
}

/// The life of the child. `out` is the pipe to the parent, whose process is `parent`.
[[noreturn]] void live_confined(int out, pid_t parent, const ChildLimits& limits,
                                const std::function<void(const ConfinedChild::Write&)>& body) {
  for (const int crash : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGPIPE})
    std::signal(crash, SIG_DFL);
  constexpr int kOut = 3;
  const bool is_confined = ::prctl(PR_SET_PDEATHSIG, SIGKILL) == 0 && ::getppid() == parent &&
                           limit_memory(limits.memory) && limit(RLIMIT_CPU, limits.seconds) &&
                           limit(RLIMIT_CORE, 0) && (out == kOut || ::dup2(out, kOut) == kOut) &&
                           ::syscall(SYS_close_range, 0, kOut - 1, 0) == 0 &&
                           ::syscall(SYS_close_range, kOut + 1, ~0U, 0) == 0 &&
                           confine_system_calls();
  if (!is_confined) ::_exit(kNotConfined);
  try {
    body([](const void* bytes, std::size_t size) {
      const auto* next = static_cast<const char*>(bytes);
      while (size > 0) {
        const ssize_t written = ::write(kOut, next, size);
        if (written <= 0) ::_exit(kThrew);
        next += written;
        size -= static_cast<std::size_t>(written);
      }
    });
  } catch (const std::bad_alloc&) {
    ::_exit(kOutOfMemory);
  } catch (...) {
    ::_exit(kThrew);
  }
  ::_exit(kDone);
}

}  // namespace

ConfinedChild::ConfinedChild(const ChildLimits& limits,
                             const std::function<void(const Write&)>& body)
    : limits_(limits) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0)
    throw Error("cannot make a pipe: " + std::system_category().message(errno));
  results_ = Descriptor(ends[0]);
  const Descriptor out(ends[1]);
  const pid_t parent = ::getpid();
  process_ = ::fork();
  if (process_ < 0)
    throw Error("cannot start a child process: " + std::system_category().message(errno));
  if (process_ == 0) live_confined(out.get(), parent, limits, body);
}

ConfinedChild::~ConfinedChild() {
  if (process_ < 0) return;
  ::kill(process_, SIGKILL);
  while (::waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

void ConfinedChild::read(void* bytes, std::size_t size, const Work& work) {
  auto* next = static_cast<char*>(bytes);
  while (size > 0) {
    pollfd wait{results_.get(), POLLIN, 0};
    const int ready = ::poll(&wait, 1, 50);
    work.poll();
    if (ready <= 0) continue;
    const ssize_t got = ::read(results_.get(), next, size);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) throw_reason();
    next += got;
    size -= static_cast<std::size_t>(got);
  }
}

void ConfinedChild::throw_reason() {
  int status = 0;
  while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
  }
  process_ = -1;
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)
    throw Error("took more than " + std::to_string(limits_.seconds) + " s of processor time");
  if (WIFSIGNALED(status)) throw Error("crashed (signal " + std::to_string(WTERMSIG(status)) + ")");
  if (WEXITSTATUS(status) == kOutOfMemory)
    throw OverMemory("needs more than " + std::to_string(limits_.memory >> 20) + " MiB");
  if (WEXITSTATUS(status) == kNotConfined)
    throw Error("this system cannot confine a child process (seccomp, resource limits)");
  throw Error("ended without a result");
}

}  // namespace voxdag
