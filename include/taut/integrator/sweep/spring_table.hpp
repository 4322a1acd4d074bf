// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstring>
#include <limits>
#include <type_traits>
#include <vector>

#include "../../model/spring_set.hpp"
#include "register.hpp"

namespace taut {

/// The lengths of as many springs as a register has lanes; a division by them is a product.
template <class Scalar, int most>
struct SpringLength<integrator_detail::sweep::VectorRegister<Scalar, most>> {
    using Register = integrator_detail::sweep::VectorRegister<Scalar, most>;
    Register l2, inverse, l;

    explicit EIGEN_ALWAYS_INLINE SpringLength(const Register& square)
        : l2(max(square, Register(std::numeric_limits<Scalar>::min()))),
          inverse(reciprocal_sqrt(l2)),
          l(l2 * inverse) {}
    EIGEN_ALWAYS_INLINE Register divide(const Register& y) const { return y * inverse; }
};

}  // namespace taut

namespace taut::integrator_detail::sweep {

template <class Law, class = void>
inline constexpr bool is_vectorizable_v = false;
/// Whether a law says that its functions are plain arithmetic, which a register can do as well as a
/// number (docs/concepts.md).
template <class Law>
inline constexpr bool is_vectorizable_v<Law, std::void_t<decltype(Law::vectorizable)>> =
    Law::vectorizable;

/// Rest lengths, dampings and parameters of one law's springs, in the order in which a sweep reads
/// them: a column for each quantity of each run and each batch, or of all stars.
template <class Scalar, class Law_, class Register = VectorRegister<Scalar>>
class SpringTable {
    using Law = Law_;
    using Parameters = typename Law::template Parameters<Scalar>;
    static constexpr bool vectorizable = is_vectorizable_v<Law>;
    static constexpr std::size_t fields = vectorizable ? sizeof(Parameters) / sizeof(Scalar) : 0;
    static_assert(!vectorizable || (std::is_trivially_copyable_v<Parameters> &&
                                    sizeof(Parameters) == fields * sizeof(Scalar)),
                  "taut::SpringSystem: the Parameters of a vectorizable law hold Scalars only");

    struct Column {
        std::size_t first = 0;
        std::size_t stride = 0;  // 0: one value for all
    };
    struct ColumnReader {
        const Scalar* at;
        std::size_t step;
        EIGEN_ALWAYS_INLINE Register load() const { return Register::load(at); }
        EIGEN_ALWAYS_INLINE void next() { at += step; }
    };

public:
    /// Where a run, a batch or a plan of stars has its springs.
    struct Columns {
        Column rest_length;
        Column damping;
        Column parameters;                 // of a law that is not vectorizable
        std::array<Column, fields> field;  // of one that is: each Scalar of its parameters
    };

    /// Stands for a spring's index: a gap, with parameters of a neighbour that a law can take.
    static int gap(int neighbour) { return -1 - neighbour; }

    /// Adds springs and gaps of `set`, by their indices. Call finish() after the last addition.
    Columns add(const SpringSet<Scalar, Law>& set, const std::vector<int>& index) {
        const auto spring = [&](std::size_t i) { return index[i] < 0 ? gap(index[i]) : index[i]; };
        Columns columns;
        if (index.empty()) return columns;
        columns.rest_length = add_column(index.size(), [&](std::size_t i) {
            return index[i] < 0 ? Scalar(-1) : set.rest_length[index[i]];
        });
        if (!set.damping.empty()) {
            columns.damping =
                add_column(index.size(), [&](std::size_t i) { return set.damping[spring(i)]; });
        }
        if constexpr (vectorizable) {
            for (std::size_t f = 0; f < fields; ++f) {
                columns.field[f] = add_column(index.size(), [&](std::size_t i) {
                    std::array<Scalar, fields> values;
                    std::memcpy(values.data(), &set.parameters[spring(i)], sizeof values);
                    return values[f];
                });
            }
        } else {
            columns.parameters = {parameters_.size(), 1};
            for (std::size_t i = 0; i < index.size(); ++i) {
                parameters_.push_back(set.parameters[spring(i)]);
            }
        }
        return columns;
    }
    /// Lets the last springs be read a whole register at a time.
    void finish() {
        numbers_.resize(numbers_.size() + max_width, Scalar(0));
        if (!parameters_.empty()) {
            parameters_.resize(parameters_.size() + max_width, Parameters(parameters_.back()));
        }
        numbers_.shrink_to_fit();
        parameters_.shrink_to_fit();
    }

    /// Goes forward through the springs of some columns, as many at a time as a register has
    /// lanes.
    class Reader {
    public:
        using Law = Law_;

        /// At spring i of those columns.
        Reader(const SpringTable& table, const Columns& columns, std::size_t i)
            : rest_length_(table.reader(columns.rest_length, i)),
              damping_(table.reader(columns.damping, i)) {
            if constexpr (!vectorizable) {
                parameters_ = table.parameters_.data() + columns.parameters.first + i;
            }
            for (std::size_t f = 0; f < fields; ++f) field_[f] = table.reader(columns.field[f], i);
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
            const Numbers L(max(rest_length_.load(), Register(Scalar(0)))), length(l);
            std::array<Scalar, Register::width> result;
            for (std::size_t lane = 0; lane < result.size(); ++lane) {
                result[lane] =
                    Law::energy(parameters_of(lane), L.values[lane], length.values[lane]);
            }
            return Register::load(result.data());
        }
        /// The pull of the springs here, 0 in the gaps: see pull_coefficients.
        template <bool Dampers, bool Rayleigh>
        EIGEN_ALWAYS_INLINE Pull<Register> pull(Scalar alpha, const Register& l2,
                                                const Register& dx_dv) const {
            const auto pull = pull_coefficients<Dampers, Rayleigh>(*this, alpha, l2, dx_dv);
            const Register L = rest_length_.load();
            return {unless_negative(L, pull.of_dx),
                    !Rayleigh ? pull.of_dv : unless_negative(L, pull.of_dv)};
        }
        /// The pull of the springs here one step ahead, 0 in the gaps: see pull_ahead_coefficients.
        template <bool Dampers, bool Rayleigh>
        EIGEN_ALWAYS_INLINE PullAhead<Register> pull_ahead(Scalar alpha, const Register& y2,
                                                           const Register& y_dv,
                                                           const Register& l2) const {
            auto pull = pull_ahead_coefficients<Dampers, Rayleigh>(*this, alpha, y2, y_dv, l2);
            const Register L = rest_length_.load();
            pull.of_dx = unless_negative(L, pull.of_dx);
            pull.of_here = unless_negative(L, pull.of_here);
            if constexpr (Rayleigh) pull.of_dv = unless_negative(L, pull.of_dv);
            return pull;
        }

    private:
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
                return lane_by_lane(function, Numbers(max(L, Register(Scalar(0)))),
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

private:
    /// The lanes of a register, for a law that takes one number at a time.
    struct Numbers {
        std::array<Scalar, Register::width> values;
        explicit Numbers(const Register& lanes) { lanes.store(values.data()); }
    };

    ColumnReader reader(const Column& column, std::size_t i) const {
        return {numbers_.data() + column.first + column.stride * i,
                column.stride * Register::width};
    }
    template <class Value>
    Column add_column(std::size_t count, Value value) {
        bool same = true;
        for (std::size_t i = 1; i < count && same; ++i) same = value(i) == value(0);
        if (same && shared_ < numbers_.size() && numbers_[shared_] == value(0)) {
            return {shared_, 0};
        }
        // Aligned like the planes, a register never lies across two cache lines.
        const std::size_t first = (numbers_.size() + max_width - 1) / max_width * max_width;
        numbers_.resize(first, Scalar(0));
        if (same) {
            numbers_.resize(first + max_width, value(0));
            shared_ = first;
        } else {
            for (std::size_t i = 0; i < count; ++i) numbers_.push_back(value(i));
        }
        return {first, same ? 0u : 1u};
    }

    std::vector<Scalar, Eigen::aligned_allocator<Scalar>> numbers_;  // columns one after another
    std::vector<Parameters> parameters_;    // of a law that is not vectorizable
    std::size_t shared_ = std::size_t(-1);  // the last column of one value, or none
};

}  // namespace taut::integrator_detail::sweep
