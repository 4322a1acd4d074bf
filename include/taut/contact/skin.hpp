// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <istream>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "contact.hpp"
#include "detail/kept_sets.hpp"

namespace taut {

/// How far a particle may be from its place on a character's skin.
template <class Scalar>
struct SkinLimit {
    /// No limit.
    static constexpr Scalar none = std::numeric_limits<Scalar>::infinity();

    Scalar max_distance = none;       ///< from it, m, ≥ 0
    Scalar backstop_distance = none;  ///< of a backstop behind it, against the normal, m, ≥ 0
    Scalar backstop_radius = none;    ///< of the ball there, m, > 0; infinite: a plane
};

/// A character that particles stay close to [T40]: greatest distances from the skin, backstops
/// behind it, and tethers to pins. Like contact this takes nothing off the certified step, and the
/// skin's work is in contacts.work().
///
///     taut::Skin skin(contacts, positions, normals);
///     skin.limit(i, {0.05f, 0.01f});  // 5 cm from the skin, 1 cm behind it
///     skin.tether(i, pin, 0.4f);
///     skin.move_to(positions, normals);  // where the skin is at the end of the frame
///     guard.advance(state, 1.0f / 60, contacts);
///
/// What begins outside is pulled back at 1 m/s. To limit, to tether or to lift a limit is an edit
/// between frames.
template <class System>
class Skin {
public:
    using Scalar = typename System::Scalar;
    static constexpr int Dim = System::Dim;
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;
    using Positions = Points<Scalar, Dim>;

    /// Keeps a reference: contacts, and its system, must outlive this.
    /// @param positions  of each particle on the skin, m, Dim × n
    /// @param normals    out of it, Dim × n of any length but 0; or none, where no backstop is
    explicit Skin(Contacts<System>& contacts, const Positions& positions,
                  const Positions& normals = {})
        : contacts_(&contacts), size_(contacts.system().size()) {
        max_distance_ = keep<Balls>(size_);
        backstop_ = keep<Before>(size_);
        move_to(positions, normals);
    }
    explicit Skin(Contacts<System>&&, const Positions&, const Positions& = {}) = delete;

    /// Limits a free particle, in the place of its last limit. Fails by name unless numbers are in
    /// range, and for a backstop unless normals were given.
    void limit(Index particle, const SkinLimit<Scalar>& limit) {
        require_free("Skin::limit", particle);
        require_size("max_distance", limit.max_distance, Scalar(0));
        require_size("backstop_distance", limit.backstop_distance, Scalar(0));
        require_size("backstop_radius", limit.backstop_radius,
                     std::numeric_limits<Scalar>::denorm_min());
        const Vector place = positions_.col(particle);
        max_distance_->remove(particle);
        backstop_->remove(particle);
        if (detail::is_finite(limit.max_distance))
            max_distance_->put({particle, limit.max_distance, place, place});
        if (detail::is_finite(limit.backstop_distance)) {
            if (normals_.cols() == 0) fail("Skin::limit: a backstop needs the skin's normals");
            const Vector normal = normals_.col(particle);
            backstop_->put({particle, limit.backstop_radius, place, place, normal, normal,
                            limit.backstop_distance});
        }
        contacts_->edited();
    }
    /// Limits all free particles by weights as they are painted on a mesh: at 0 a particle follows
    /// the skin, at 1 it has this limit, between its max_distance is in proportion.
    /// @param weights  n in [0, 1], of a vertex colour or of read_weights(); else fails by name
    void limit_all(const std::vector<Scalar>& weights, const SkinLimit<Scalar>& at_one) {
        if (static_cast<Index>(weights.size()) != size_)
            fail("Skin::limit_all: ", weights.size(), " weights for ", size_, " particles");
        for (Index i = 0; i < size_; ++i) {
            const Scalar weight = weights[static_cast<std::size_t>(i)];
            if (!(weight >= 0 && weight <= 1))
                fail("Skin::limit_all: weight ", i, " is ", weight, "; it must be in [0, 1]");
            if (contacts_->system().is_pinned(i)) continue;
            SkinLimit<Scalar> own = at_one;
            own.max_distance = weight < 1 ? weight * at_one.max_distance : at_one.max_distance;
            if (weight == 0) own.max_distance = 0;
            limit(i, own);
        }
    }
    /// Keeps a free particle within a length, m, ≥ 0, of a pin, which may move. A particle may have
    /// several. Fails by name unless the length is finite and the anchor pinned; open() unless it
    /// stays so.
    void tether(Index particle, Index anchor, Scalar length) {
        require_free("Skin::tether", particle);
        require_non_negative("Skin::tether", "length", length);
        if (!is_particle(anchor) || !contacts_->system().is_pinned(anchor))
            fail("Skin::tether: the anchor ", anchor, " is no pin");
        const Vector zero = Vector::Zero();
        std::size_t k = 0;
        while (k < tethers_.size() && tethers_[k]->of(particle)) ++k;
        if (k == tethers_.size()) tethers_.push_back(keep<Tethers>(contacts_->system()));
        tethers_[k]->put({particle, length, zero, zero, zero, zero, 0, anchor});
        contacts_->edited();
    }
    /// Where the skin is at the end of the next frame: each place goes there on a straight line.
    /// Fails by name unless there are as many as particles and all are finite.
    void move_to(const Positions& positions, const Positions& normals = {}) {
        if (positions.cols() != size_ || !detail::all_finite(positions))
            fail("Skin: positions must be finite, and as many as particles: ", size_);
        const bool has_normals = normals.cols() != 0 || !backstop_->sets().empty();
        if (has_normals && (normals.cols() != size_ || !detail::all_finite(normals)))
            fail("Skin: normals must be finite, and as many as particles: ", size_);
        positions_ = positions;
        normals_ = normals;
        for (Index i = 0; i < normals.cols(); ++i) {
            const Scalar length = normals.col(i).stableNorm();
            if (!(length > 0)) fail("Skin: the normal of particle ", i, " is 0");
            normals_.col(i) /= length;
        }
        for (auto& set : max_distance_->sets()) set.end = positions_.col(set.particle);
        for (auto& set : backstop_->sets()) {
            set.end = positions_.col(set.particle);
            set.end_normal = normals_.col(set.particle);
        }
    }

private:
    using Balls = contact_detail::KeptInBalls<Scalar, Dim>;
    using Before = contact_detail::KeptBefore<Scalar, Dim>;
    /// Whose anchors must stay pinned.
    class Tethers final : public Balls {
    public:
        Tethers(const System& system) : Balls(system.size()), system_(&system) {}
        void open(const State<Scalar, Dim>& state) override {
            for (const auto& set : this->sets()) {
                if (!system_->is_pinned(set.anchor))
                    fail("Skin: the anchor ", set.anchor, " of a tether is no pin any more");
            }
            Balls::open(state);
        }

    private:
        const System* system_;
    };

    template <class Sets, class Argument>
    Sets* keep(const Argument& argument) {
        auto sets = std::make_unique<Sets>(argument);
        Sets* kept = sets.get();
        contacts_->keep(std::move(sets));
        return kept;
    }
    bool is_particle(Index i) const { return i >= 0 && i < size_; }
    void require_free(const char* function, Index particle) const {
        if (!is_particle(particle)) fail(function, ": there is no particle ", particle);
        if (contacts_->system().is_pinned(particle))
            fail(function, ": particle ", particle, " is pinned");
    }
    static void require_size(const char* name, Scalar value, Scalar least) {
        if (!(value >= least))
            fail("Skin::limit: ", name, " is ", value, "; it must be >= ", least);
    }

    Contacts<System>* contacts_;
    Index size_;
    Positions positions_, normals_;  // where the next frame ends
    Balls* max_distance_;
    Before* backstop_;
    std::vector<Tethers*> tethers_;
};

/// A column of weights from text, one number a line. What is no number ends it.
template <class Scalar>
std::vector<Scalar> read_weights(std::istream& text) {
    std::vector<Scalar> weights;
    for (Scalar weight; text >> weight;) weights.push_back(weight);
    return weights;
}

}  // namespace taut
