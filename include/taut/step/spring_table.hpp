// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstring>
#include <limits>
#include <type_traits>
#include <vector>

#include "../network/spring_set.hpp"
#include "sorted_springs.hpp"

namespace taut {

/// The lengths of as many springs as a register has lanes; a division by them is a product. Not
/// below 2√η: Eigen takes half of l², and what is below η costs as much as dozens of springs.
template <class Scalar, int most>
struct SpringLength<step_detail::VectorRegister<Scalar, most>> {
    using Register = step_detail::VectorRegister<Scalar, most>;
    Register l2, inverse, l;

    explicit EIGEN_ALWAYS_INLINE SpringLength(const Register& square)
        : l2(larger(square, Register(4 * (std::numeric_limits<Scalar>::min)()))),
          inverse(reciprocal_sqrt(l2)),
          l(l2 * inverse) {}
    EIGEN_ALWAYS_INLINE Register divide(const Register& y) const { return y * inverse; }
};

}  // namespace taut

namespace taut::step_detail {

template <class Law, class = void>
inline constexpr bool is_vectorizable_v = false;
/// Whether a law says that its functions are plain arithmetic, which a register can do as well as a
/// number (docs/concepts.md).
template <class Law>
inline constexpr bool is_vectorizable_v<Law, std::void_t<decltype(Law::vectorizable)>> =
    Law::vectorizable;

/// Numbers of springs, in the order in which a sweep reads them: a column for each quantity of each
/// run and each batch, or of all stars.
template <class Scalar>
class ColumnTable {
public:
    struct Column {
        std::size_t first = 0;
        std::size_t stride = 0;  // 0: one value for all
    };
    const Scalar* numbers() const { return numbers_.data(); }
    /// Those from the first of an addition on.
    const Column* columns(std::size_t first) const { return columns_.data() + first; }

protected:
    /// Adds a column of springs and gaps.
    /// @param values  of the set's spring 0, `apart` bytes from those of the next
    /// @param gaps    whether a gap has −1 in place of its neighbour's
    TAUT_COLD void add_column(const void* values, std::size_t apart, const Buffer<int>& index,
                              int first, int end, bool gaps);
    /// Lets the last springs be read a whole register at a time.
    TAUT_COLD void finish() {
        numbers_.resize(numbers_.size() + max_width, Scalar(0));
        numbers_.fit();
    }

private:
    Buffer<Scalar> numbers_;  // columns one after another
    Buffer<Column> columns_;
    std::size_t shared_ = std::size_t(-1);  // the last column of one value, or none
};

template <class Scalar, class Law, class Register>
class SpringReader;

/// Rest lengths, dampings and parameters of one law's springs.
template <class Scalar, class Law>
class SpringTable : public ColumnTable<Scalar> {
public:
    using Parameters = typename Law::template Parameters<Scalar>;
    static constexpr bool vectorizable = is_vectorizable_v<Law>;
    static constexpr std::size_t fields = vectorizable ? sizeof(Parameters) / sizeof(Scalar) : 0;
    static_assert(!vectorizable || (std::is_trivially_copyable_v<Parameters> &&
                                    sizeof(Parameters) == fields * sizeof(Scalar)),
                  "taut::SpringSystem: the Parameters of a vectorizable law hold Scalars only");

    /// Adds springs and gaps of `set`: those of index from `first` to before `end`. Call finish()
    /// after the last addition. A SpringReader knows them by the number of additions before.
    TAUT_COLD void add(const SpringSet<Scalar, Law>& set, const Buffer<int>& index, int first,
                       int end) {
        this->add_column(set.rest_length.data(), sizeof(Scalar), index, first, end, true);
        const Scalar none = 0;
        set.damping.empty()
            ? this->add_column(&none, 0, index, first, end, false)
            : this->add_column(set.damping.data(), sizeof(Scalar), index, first, end, false);
        if constexpr (vectorizable) {
            const auto* all =
                reinterpret_cast<const char*>(set.parameters.data());  // null for none
            for (std::size_t f = 0; f < fields; ++f) {
                this->add_column(all ? all + f * sizeof(Scalar) : all, sizeof(Parameters), index,
                                 first, end, false);
            }
        } else {
            first_parameters_.push_back(parameters_.size());
            for (int i = first; i < end; ++i) {
                const int at = index[i];
                parameters_.push_back(set.parameters[at < 0 ? gap(at) : at]);
            }
        }
    }
    /// Lets the last springs be read a whole register at a time.
    void finish() {
        ColumnTable<Scalar>::finish();
        if constexpr (!vectorizable) {
            auto& all = parameters_;
            if (!all.empty()) all.resize(all.size() + max_width, Parameters(all.back()));
            all.shrink_to_fit();
        }
    }

private:
    template <class, class, class>
    friend class SpringReader;

    // Of a law that is not vectorizable.
    struct Nothing {};
    std::conditional_t<vectorizable, Nothing, std::vector<Parameters>> parameters_;
    std::conditional_t<vectorizable, Nothing, Buffer<std::size_t>>
        first_parameters_;  // by addition
};

/// Goes forward through springs of a table, as many at a time as a register has lanes.
template <class Scalar, class Law_, class Register>
class SpringReader {
    using Table = SpringTable<Scalar, Law_>;
    using Parameters = typename Table::Parameters;
    static constexpr bool vectorizable = Table::vectorizable;
    static constexpr std::size_t fields = Table::fields;
    struct ColumnReader {
        const Scalar* at;
        std::size_t step;
        EIGEN_ALWAYS_INLINE Register load() const { return Register::load(at); }
        EIGEN_ALWAYS_INLINE void next() { at += step; }
    };

public:
    using Law = Law_;

    /// At spring i of those that `table` took by its addition `number`, counted from 0.
    SpringReader(const Table& table, int number, std::size_t i) {
        const auto* column = table.columns(static_cast<std::size_t>(number) * (2 + fields));
        const auto reader = [&](std::size_t c) -> ColumnReader {
            return {table.numbers() + column[c].first + column[c].stride * i,
                    column[c].stride * Register::width};
        };
        rest_length_ = reader(0);
        damping_ = reader(1);
        for (std::size_t f = 0; f < fields; ++f) field_[f] = reader(2 + f);
        if constexpr (!vectorizable) {
            parameters_ = table.parameters_.data() + table.first_parameters_[number] + i;
        }
    }
    EIGEN_ALWAYS_INLINE void next() {
        rest_length_.next();
        damping_.next();
        for (auto& field : field_) field.next();
        if constexpr (!vectorizable) parameters_ += Register::width;
    }
    // The springs here, as Spring has it for one.
    EIGEN_ALWAYS_INLINE Register tension(const Register& l) const {
        return evaluate([](const auto&... of) { return Law::tension(of...); }, l);
    }
    EIGEN_ALWAYS_INLINE Register tension_slope(const Register& l) const {
        return evaluate([](const auto&... of) { return Law::tension_slope(of...); }, l);
    }
    EIGEN_ALWAYS_INLINE Register stiffness_bound() const {
        return evaluate([](const auto&... of) { return Law::stiffness_bound(of...); });
    }
    EIGEN_ALWAYS_INLINE Register axial_damping() const { return damping_.load(); }
    /// Lane by lane: no law's energy need take a register.
    Register energy(const Register& l) const {
        const Numbers L(larger(rest_length_.load(), Register(Scalar(0)))), length(l);
        std::array<Scalar, Register::width> result;
        for (std::size_t lane = 0; lane < result.size(); ++lane) {
            result[lane] = Law::energy(parameters_of(lane), L.values[lane], length.values[lane]);
        }
        return Register::load(result.data());
    }
    /// The pull of the springs here, 0 in the gaps: see pull_coefficients.
    template <bool Damped>
    EIGEN_ALWAYS_INLINE Pull<Register> pull(Scalar alpha, const Register& l2,
                                            const Register& dx_dv) const {
        auto pull = pull_coefficients<Damped>(*this, alpha, l2, dx_dv);
        leave_gaps<Damped>(alpha, rest_length_.load(), pull);
        return pull;
    }
    /// The pull of the springs here one step ahead, 0 in the gaps: see pull_ahead_coefficients.
    template <bool Damped>
    EIGEN_ALWAYS_INLINE PullAhead<Register> pull_ahead(Scalar alpha, const Register& y2,
                                                       const Register& y_dv,
                                                       const Register& l2) const {
        auto pull = pull_ahead_coefficients<Damped>(*this, alpha, y2, y_dv, l2);
        const Register L = rest_length_.load();
        leave_gaps<Damped>(alpha, L, pull);
        pull.of_here = unless_negative(L, pull.of_here);
        return pull;
    }
    /// The one or, if Both, the other.
    template <bool Damped, bool Both>
    EIGEN_ALWAYS_INLINE auto pull_of(Scalar alpha, const Register& l2, const Register& dx_dv,
                                     [[maybe_unused]] const Register& old_l2) const {
        if constexpr (Both) {
            return pull_ahead<Damped>(alpha, l2, dx_dv, old_l2);
        } else {
            return pull<Damped>(alpha, l2, dx_dv);
        }
    }

private:
    template <bool Damped>
    static EIGEN_ALWAYS_INLINE void leave_gaps(Scalar alpha, const Register& L,
                                               Pull<Register>& pull) {
        pull.of_dx = unless_negative(L, pull.of_dx);
        if (Damped && alpha > 0) pull.of_dv = unless_negative(L, pull.of_dv);
    }
    /// The lanes of a register, for a law that takes one number at a time.
    struct Numbers {
        std::array<Scalar, Register::width> values;
        explicit Numbers(const Register& lanes) { lanes.store(values.data()); }
    };

    /// function(p, L, more…) of each spring.
    template <class Function, class... More>
    EIGEN_ALWAYS_INLINE Register evaluate(Function function, const More&... more) const {
        const Register L = rest_length_.load();
        if constexpr (vectorizable) {
            std::array<Register, fields> values;
            for (std::size_t f = 0; f < fields; ++f) values[f] = field_[f].load();
            typename Law::template Parameters<Register> p;
            std::memcpy(&p, values.data(), sizeof p);
            return function(p, L, more...);
        } else {
            // A gap has a length that no spring has; a law must not see it.
            return lane_by_lane(function, Numbers(larger(L, Register(Scalar(0)))),
                                Numbers(more)...);
        }
    }
    /// Of the spring in one lane.
    Parameters parameters_of(std::size_t lane) const {
        if constexpr (vectorizable) {
            std::array<Scalar, fields> values;
            for (std::size_t f = 0; f < fields; ++f) {
                values[f] = Numbers(field_[f].load()).values[lane];
            }
            Parameters p;
            std::memcpy(&p, values.data(), sizeof p);
            return p;
        } else {
            return parameters_[lane];
        }
    }
    template <class Function, class... More>
    Register lane_by_lane(Function function, const More&... more) const {
        std::array<Scalar, Register::width> result;
        for (std::size_t lane = 0; lane < result.size(); ++lane) {
            result[lane] = function(parameters_[lane], more.values[lane]...);
        }
        return Register::load(result.data());
    }

    ColumnReader rest_length_;
    ColumnReader damping_;
    std::array<ColumnReader, fields> field_;
    const Parameters* parameters_ = nullptr;
};

}  // namespace taut::step_detail

#if !defined(TAUT_COMPILED)
#include "spring_table-inl.hpp"
#endif
