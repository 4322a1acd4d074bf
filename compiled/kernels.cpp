// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "by_kernel.hpp"
#include "kernels.hpp"

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <taut/kernels.hpp>

// TAUT_KERNELS_AVX2 and TAUT_KERNELS_AVX512 say which wide units the library has. Those that its
// own flags make no wider than what is here anyway are left out.
#if defined(TAUT_KERNELS_AVX512) && defined(EIGEN_VECTORIZE_AVX512)
#undef TAUT_KERNELS_AVX512
#endif
#if defined(TAUT_KERNELS_AVX2) && defined(EIGEN_VECTORIZE_AVX2) && defined(EIGEN_VECTORIZE_FMA)
#undef TAUT_KERNELS_AVX2
#endif

#define TAUT_TABLES(SET)                                            \
    namespace taut_##SET::step_detail {                             \
        extern const taut_kernels::Table<float> kernels_of_float;   \
        extern const taut_kernels::Table<double> kernels_of_double; \
    }
#if defined(TAUT_KERNELS_AVX2)
TAUT_TABLES(avx2)
#endif
#if defined(TAUT_KERNELS_AVX512)
TAUT_TABLES(avx512)
#endif

namespace taut {
namespace step_detail {
namespace {

struct Kernels {
    const char* name;
    int bytes;  // of a register
    const taut_kernels::Table<float>* of_float;
    const taut_kernels::Table<double>* of_double;
};

/// Whether a wide unit has the classes that this one has.
template <class Scalar>
bool same_classes(const taut_kernels::Table<Scalar>* table) {
    taut_kernels::Table<Scalar> here{};
    set_sizes(here);
    return std::equal(std::begin(here.sizes), std::end(here.sizes), table->sizes);
}
/// The kernels, if a name (null: any) is theirs, and unit and processor are as they should be.
[[maybe_unused]] const Kernels* if_taken(const Kernels& kernels, const char* name, bool can) {
    return can && (!name || std::strcmp(name, kernels.name) == 0) &&
                   same_classes(kernels.of_float) && same_classes(kernels.of_double)
               ? &kernels
               : nullptr;
}

/// Those of a name, or for null the widest; null where there are none.
const Kernels* find(const char* name) {
#if defined(TAUT_KERNELS_AVX512)
    static constexpr Kernels avx512 = {"avx512", 64, &taut_avx512::step_detail::kernels_of_float,
                                       &taut_avx512::step_detail::kernels_of_double};
    const bool has_512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
                         __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
                         __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    if (const auto* found = if_taken(avx512, name, has_512)) return found;
#endif
#if defined(TAUT_KERNELS_AVX2)
    static constexpr Kernels avx2 = {"avx2", 32, &taut_avx2::step_detail::kernels_of_float,
                                     &taut_avx2::step_detail::kernels_of_double};
    const bool has_2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    if (const auto* found = if_taken(avx2, name, has_2)) return found;
#endif
    static constexpr taut_kernels::Table<float> no_float{};
    static constexpr taut_kernels::Table<double> no_double{};
    static constexpr Kernels own = {detail::kernels_of_flags(), 0, &no_float, &no_double};
    return !name || std::strcmp(name, own.name) == 0 ? &own : nullptr;
}

/// What plans are made for, whatever is chosen later: all that can be chosen may run them.
const Kernels& widest() {
    static const Kernels* const found = find(nullptr);
    return *found;
}
std::atomic<const Kernels*> chosen{nullptr};  // null: the widest

const Kernels& current() {
    const Kernels* kernels = chosen.load(std::memory_order_relaxed);
    return kernels ? *kernels : widest();
}

}  // namespace

int planned_width(float) { return (std::max)(VectorRegister<float>::width, widest().bytes / 4); }
int planned_width(double) { return (std::max)(VectorRegister<double>::width, widest().bytes / 8); }

}  // namespace step_detail

// A cache line's alignment, so that no register lies across two, for Eigen's aligned_free.
void* detail::regrow(void* old, std::size_t used, std::size_t bytes) {
    [[maybe_unused]] constexpr std::size_t line = 64;
    void* grown = nullptr;
    if (bytes > 0) {
#if EIGEN_DEFAULT_ALIGN_BYTES != 0 && !EIGEN_MALLOC_ALREADY_ALIGNED
        grown = Eigen::internal::handmade_aligned_malloc(bytes, line);
#elif defined(TAUT_KERNELS)
        grown = std::aligned_alloc(line, (bytes + line - 1) / line * line);
#else
        grown = Eigen::internal::aligned_malloc(bytes);
#endif
        if (!grown) Eigen::internal::throw_std_bad_alloc();
    }
    if (used > 0) std::memcpy(grown, old, used);
    Eigen::internal::aligned_free(old);
    return grown;
}

const taut_kernels::Table<float>& detail::chosen_kernels(float) {
    return *step_detail::current().of_float;
}
const taut_kernels::Table<double>& detail::chosen_kernels(double) {
    return *step_detail::current().of_double;
}

const char* kernels() { return step_detail::current().name; }

bool set_kernels(const char* name) {
    const step_detail::Kernels* found = step_detail::find(name);
    if (found) step_detail::chosen.store(found, std::memory_order_relaxed);
    return found != nullptr;
}

}  // namespace taut
