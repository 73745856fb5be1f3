// With the preset `traps` every test program has this file: a test fails where our code divides by
// zero, overflows to infinity or makes NaN of numbers, and says where. The processor traps such
// operations of float and double, in every thread, as threads inherit its control word. The handler
// notes the place, lets the operation go on untrapped by a single step, and arms the trap anew, so
// that one run finds all places. For x86-64 and Linux.
//
// Whose code it is depends on the object that holds the instruction. Ours is the program, with what
// headers of libraries become in it, and what it calls in the mathematical library (exp of 1000).
// Embree, TBB, OpenEXR, OpenVDB, the GL driver and what that compiles at run time lie elsewhere.
// Comparisons do not count: it is by them that code finds a NaN that a file brought.

#include "tests/support/float_traps.h"

#include <dlfcn.h>
#include <execinfo.h>
#include <gtest/gtest.h>
#include <link.h>
#include <pthread.h>
#include <signal.h>
#include <ucontext.h>
#include <unistd.h>
#include <xmmintrin.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>

namespace {

constexpr unsigned kTrapped = _MM_MASK_INVALID | _MM_MASK_DIV_ZERO | _MM_MASK_OVERFLOW;
constexpr greg_t kSingleStep = 0x100;  // of EFLAGS

struct CodeRange {
    std::uintptr_t begin = 0, end = 0;
};

// Found before the first trap; the program's own comes first.
std::array<CodeRange, 8> own_code;
std::size_t own_ranges = 0;
std::uintptr_t program_base = 0;

bool is_own(std::uintptr_t at) {
    return std::any_of(own_code.begin(), own_code.end(), [at](const CodeRange& range) {
        return at >= range.begin && at < range.end;
    });
}

int note_object(dl_phdr_info* object, std::size_t, void*) {
    const bool is_program = own_ranges == 0;
    const auto is_named = [object](const char* name) {
        return std::strstr(object->dlpi_name, name) != nullptr;
    };
    if (!is_program && !is_named("/libm.so") && !is_named("/libgcc_s.so")) return 0;
    for (int i = 0; i < object->dlpi_phnum && own_ranges < own_code.size(); ++i) {
        const auto& part = object->dlpi_phdr[i];
        if (part.p_type != PT_LOAD || (part.p_flags & PF_X) == 0) continue;
        const std::uintptr_t begin = object->dlpi_addr + part.p_vaddr;
        own_code[own_ranges++] = {begin, begin + part.p_memsz};
    }
    program_base = is_program ? object->dlpi_addr : program_base;
    return 0;
}

// COMISS, CMPPS, MINPS, MAXPS and their kin, in every encoding.
bool is_comparison(const std::uint8_t* code) {
    const std::uint8_t* at = code;
    while (*at == 0x66 || *at == 0xf2 || *at == 0xf3 || (*at & 0xf0) == 0x40) {
        ++at;
    }
    const std::uint8_t opcode = *at == 0x62   ? at[4]   // EVEX
                                : *at == 0xc4 ? at[3]   // VEX of three bytes
                                : *at == 0xc5 ? at[2]   // and of two
                                              : at[1];  // after 0x0f
    return opcode == 0x2e || opcode == 0x2f || opcode == 0xc2 || opcode == 0x5d || opcode == 0x5f;
}

// A place in our code: what trapped, and who called it.
struct Trap {
    int kind = 0;  // FPE_FLTINV and so on
    int frames = 0;
    std::array<void*, 12> frame{};
};

std::array<Trap, 64> traps;  // of this test, each place once
std::atomic<std::size_t> trap_count{0};
std::atomic_flag is_noting = ATOMIC_FLAG_INIT;

void note_trap(int kind, std::uintptr_t at) {
    std::array<void*, 32> stack{};
    const int depth = backtrace(stack.data(), static_cast<int>(stack.size()));
    Trap trap{kind, 0, {}};
    // Up to `at` these are the handler's own.
    const auto* first = std::find(stack.data(), stack.data() + depth, reinterpret_cast<void*>(at));
    for (; first < stack.data() + depth && trap.frames < 12; ++first) {
        trap.frame[static_cast<std::size_t>(trap.frames++)] = *first;
    }
    while (is_noting.test_and_set()) {
    }
    const std::size_t count = trap_count;
    const bool is_known = std::any_of(traps.begin(), traps.begin() + count, [&](const Trap& other) {
        return other.frame[0] == trap.frame[0] && other.frame[1] == trap.frame[1];
    });
    if (!is_known && count < traps.size()) {
        traps[count] = trap;
        trap_count = count + 1;
    }
    is_noting.clear();
}

void handle_trap(int, siginfo_t* info, void* context) {
    auto& machine = static_cast<ucontext_t*>(context)->uc_mcontext;
    const auto at = static_cast<std::uintptr_t>(machine.gregs[REG_RIP]);
    if (is_own(at) && !is_comparison(reinterpret_cast<const std::uint8_t*>(at))) {
        note_trap(info->si_code, at);
    }
    machine.fpregs->mxcsr |= kTrapped;
    machine.gregs[REG_EFL] |= kSingleStep;
}

void handle_step(int, siginfo_t*, void* context) {
    auto& machine = static_cast<ucontext_t*>(context)->uc_mcontext;
    machine.fpregs->mxcsr &= ~(kTrapped | _MM_EXCEPT_MASK);
    machine.gregs[REG_EFL] &= ~kSingleStep;
}

// Threads of a GL driver block the signals, and a trap that cannot be handled ends the program:
// what starts elsewhere than in the program, the library of C++ and TBB inherits no traps.
bool starts_here(void* (*routine)(void*)) {
    Dl_info object{};
    const auto at = reinterpret_cast<std::uintptr_t>(routine);
    return is_own(at) || dladdr(reinterpret_cast<void*>(at), &object) == 0 ||
           std::strstr(object.dli_fname, "/libstdc++.so") != nullptr ||
           std::strstr(object.dli_fname, "/libtbb.so") != nullptr;
}

// Function and line of a return address in the program, by binutils.
std::string place_of(void* address) {
    const std::uintptr_t at = reinterpret_cast<std::uintptr_t>(address);
    if (at < own_code[0].begin || at >= own_code[0].end) return "  in a library\n";
    char command[128];
    std::snprintf(command, sizeof command, "addr2line -Cfipe /proc/%d/exe %zx", getpid(),
                  static_cast<std::size_t>(at - program_base));
    std::string text;
    if (FILE* pipe = popen(command, "r")) {
        for (char line[1024]; std::fgets(line, sizeof line, pipe) != nullptr;) {
            text += "  " + std::string(line);
        }
        pclose(pipe);
    }
    return text;
}

// What may overflow, or subtract one infinity from another, on purpose. Divisions by zero are never
// meant.
struct Deliberate {
    std::string_view function, why;
};
constexpr std::array kDeliberate{
    Deliberate{"gltf::build_primitives(", "a file's positions may not fit; not finite: refused"},
    Deliberate{"gltf::read_primitive(", "the same of morph targets"},
    Deliberate{"gltf::parse_document(", "a file's quaternions may not fit; then they are none"},
    Deliberate{"gltf::build_lights(", "a file's lights may be too far; not finite: refused"},
    Deliberate{"formats::import_gltf(", "the same, inlined"},
    Deliberate{"vdb::is_invertible_affine(", "a file's transform may not fit; then it is none"},
    Deliberate{"formats::find_volume_value_fault(", "tells whether a density fits"},
    Deliberate{"runtime::make_layer_field(", "wind times time may not fit; then it moves nothing"},
    Deliberate{"bake::find_columns(", "lanes of empty pixels are -infinity; all comparisons fail"},
};

bool is_deliberate(const Trap& trap, const std::string& function) {
    return trap.kind != FPE_FLTDIV &&
           std::any_of(kDeliberate.begin(), kDeliberate.end(), [&](const Deliberate& meant) {
               return function.find(meant.function) != std::string::npos;
           });
}

class TrapListener : public testing::EmptyTestEventListener {
    void OnTestStart(const testing::TestInfo&) override { trap_count = 0; }
    void OnTestEnd(const testing::TestInfo&) override {
        for (std::size_t i = 0; i < trap_count; ++i) {
            report(traps[i]);
        }
    }
    static void report(const Trap& trap) {
        std::string text = trap.kind == FPE_FLTDIV   ? "division by zero:\n"
                           : trap.kind == FPE_FLTOVF ? "overflow:\n"
                                                     : "invalid operation:\n";
        for (int k = 0; k < std::min(trap.frames, 6); ++k) {
            text += place_of(trap.frame[static_cast<std::size_t>(k)]);
            // What is called by a deliberate function is a small function of its arguments.
            if (k < 3 && is_deliberate(trap, text)) return;
        }
        ADD_FAILURE() << text;
    }
};

const bool is_armed = [] {
    dl_iterate_phdr(note_object, nullptr);
    std::array<void*, 2> warm_up{};
    backtrace(warm_up.data(), 2);  // loads what a signal handler must not
    struct sigaction action {};
    action.sa_flags = SA_SIGINFO;
    action.sa_sigaction = handle_trap;
    sigaction(SIGFPE, &action, nullptr);
    action.sa_sigaction = handle_step;
    sigaction(SIGTRAP, &action, nullptr);
    testing::UnitTest::GetInstance()->listeners().Append(new TrapListener);
    _mm_setcsr(_mm_getcsr() & ~(kTrapped | _MM_EXCEPT_MASK));
    const volatile float zero = 0;
    [[maybe_unused]] const volatile float infinite = 1 / zero;
    if (trap_count != 1) {
        std::fputs("floating-point operations are not trapped\n", stderr);
        std::abort();
    }
    return true;
}();

}  // namespace

// In place of the library's, also for libraries.
extern "C" int pthread_create(pthread_t* thread, const pthread_attr_t* attributes,
                              void* (*routine)(void*), void* argument) noexcept {
    using Create = int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
    static const auto create = reinterpret_cast<Create>(dlsym(RTLD_NEXT, "pthread_create"));
    if (starts_here(routine)) return create(thread, attributes, routine, argument);
    const opaline::tests::UntrappedFloats untrapped;
    return create(thread, attributes, routine, argument);
}
