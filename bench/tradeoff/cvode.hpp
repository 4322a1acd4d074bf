// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_spgmr.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <stdexcept>

#include "../odeint.hpp"

namespace bench {

/// SUNDIALS CVODE on y = (x, v) of an undamped net, with steps and orders by its own error control:
/// Adams formulas by fixed-point iteration, or backward differences by Newton and GMRES.
class Cvode {
public:
    /// @param method  CV_ADAMS or CV_BDF   @param tolerance  relative, and absolute in m and m/s
    Cvode(const Net& net, int method, double tolerance)
        : acceleration_(net), state_(net.initial_state()) {
        if (SUNContext_Create(nullptr, &context_) != 0) throw std::runtime_error("CVODE: context");
        half_ = state_.x.size();
        y_ = N_VNew_Serial(2 * half_, context_);
        std::copy(state_.x.data(), state_.x.data() + half_, N_VGetArrayPointer(y_));
        std::copy(state_.v.data(), state_.v.data() + half_, N_VGetArrayPointer(y_) + half_);
        memory_ = CVodeCreate(method, context_);
        require(CVodeInit(memory_, &Cvode::rate, 0, y_));
        require(CVodeSStolerances(memory_, tolerance, tolerance));
        require(CVodeSetUserData(memory_, this));
        require(CVodeSetMaxNumSteps(memory_, 10'000'000));
        if (method == CV_ADAMS) {
            fixed_point_ = SUNNonlinSol_FixedPoint(y_, 0, context_);
            require(CVodeSetNonlinearSolver(memory_, fixed_point_));
        } else {
            gmres_ = SUNLinSol_SPGMR(y_, SUN_PREC_NONE, 0, context_);
            require(CVodeSetLinearSolver(memory_, gmres_, nullptr));
        }
    }
    Cvode(const Cvode&) = delete;
    Cvode& operator=(const Cvode&) = delete;
    ~Cvode() {
        CVodeFree(&memory_);
        if (fixed_point_) SUNNonlinSolFree(fixed_point_);
        if (gmres_) SUNLinSolFree(gmres_);
        N_VDestroy(y_);
        SUNContext_Free(&context_);
    }
    /// Moves on by `span`, s. @returns whether it could
    bool advance(double span) {
        time_ += span;
        sunrealtype reached = 0;
        return CVode(memory_, time_, y_, &reached, CV_NORMAL) == CV_SUCCESS;
    }
    const Net::State& state() {
        const double* y = N_VGetArrayPointer(y_);
        std::copy(y, y + half_, state_.x.data());
        std::copy(y + half_, y + 2 * half_, state_.v.data());
        return state_;
    }

private:
    static void require(int flag) {
        if (flag != CV_SUCCESS) throw std::runtime_error("CVODE refused its set-up");
    }
    static int rate(sunrealtype, N_Vector y, N_Vector into, void* self) {
        auto& me = *static_cast<Cvode*>(self);
        const double* from = N_VGetArrayPointer(y);
        double* to = N_VGetArrayPointer(into);
        std::copy(from + me.half_, from + 2 * me.half_, to);
        me.acceleration_(from, to + me.half_);
        return 0;
    }

    Acceleration acceleration_;
    Net::State state_;
    Eigen::Index half_ = 0;  // entries of x
    double time_ = 0;        // s
    SUNContext context_ = nullptr;
    N_Vector y_ = nullptr;
    void* memory_ = nullptr;
    SUNNonlinearSolver fixed_point_ = nullptr;
    SUNLinearSolver gmres_ = nullptr;
};

}  // namespace bench
