// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

#include "scene.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <taut/scene/cloth.hpp>
#include <taut/scene/mesh.hpp>
#include <taut/mesh_files/weld.hpp>
#include <utility>

#include "../examples/common/obj_text.hpp"
#include "lab.hpp"

namespace lab {

namespace {

constexpr taut::Index most_vertices = 50'000;
constexpr double bend_share = 0.1;  // of bending springs, of the stiffness of the others
constexpr double gravity = 9.81;    // m/s²

struct File {
    std::string text;
    std::optional<example::ObjText> obj;
};

Scene current;
File file;
std::string words;
LabShape shape{};
std::vector<int> triangles;
std::vector<int> threads;
std::vector<unsigned char> pinned;

bool refuse(std::string why) {
    words = std::move(why);
    return false;
}
void tell(const std::string& sentence) {
    if (!words.empty()) words += '\n';
    words += sentence;
}

/// "1 vertex", "2 vertices"
std::string vertices(taut::Index count) {
    return std::to_string(count) + (count == 1 ? " vertex" : " vertices");
}
/// As the file counts it.
std::string vertex(const example::ObjText& obj, taut::Index v) {
    return "vertex " + std::to_string(v + 1) + " (line " +
           std::to_string(obj.vertex_lines[static_cast<std::size_t>(v)]) + ")";
}

/// The file's vertices in metres with z up: a rotation, so that nothing is mirrored.
taut::Points<double, 3> upright(const taut::Points<double, 3>& x, double scale, int up) {
    taut::Points<double, 3> turned(3, x.cols());
    if (up == 0) {
        turned << x.row(1), x.row(2), x.row(0);
    } else if (up == 1) {
        turned << x.row(0), -x.row(2), x.row(1);
    } else {
        turned = x;
    }
    return scale * turned;
}

/// Whether every vertex is where a picture and a proof can be made of it.
bool check_place(const example::ObjText& obj, const taut::Points<double, 3>& x) {
    constexpr double farthest = 1e6;  // m
    for (taut::Index v = 0; v < x.cols(); ++v) {
        if (!(x.col(v).cwiseAbs().maxCoeff() <= farthest))
            return refuse("With this scale " + vertex(obj, v) + " is more than 1000 km away.");
    }
    const Eigen::Vector3d size = x.rowwise().maxCoeff() - x.rowwise().minCoeff();
    return size.maxCoeff() >= 1e-6 || refuse("All vertices lie within a micrometre of " +
                                             vertex(obj, 0) + ". Is the unit right?");
}

/// Whether every vertex can have its share of the area.
bool check_area(const example::ObjText& obj, const taut::Points<double, 3>& x,
                const std::vector<std::vector<taut::Index>>& faces) {
    const Eigen::VectorXd area = taut::scene_detail::areas_of_vertices(x, faces);
    for (const auto& face : faces) {
        for (const auto v : face) {
            if (!(area[v] > 0))
                return refuse("No face around " + vertex(obj, v) +
                              " has an area: it would have no mass.");
        }
    }
    return true;
}

/// Whether stiffness can be by length.
bool check_length(const example::ObjText& obj, const taut::Points<double, 3>& x,
                  const std::vector<std::vector<taut::Index>>& faces) {
    const auto mesh = taut::springs_from_mesh<double>(x, faces, {1, bend_share, 1});
    std::vector<taut::Index> vertex_of(std::size_t(mesh.system.size()));
    for (std::size_t v = 0; v < mesh.particle_of_vertex.size(); ++v) {
        const auto particle = mesh.particle_of_vertex[v];
        if (particle >= 0) vertex_of[std::size_t(particle)] = taut::Index(v);
    }
    bool good = true;
    mesh.system.for_each_spring([&](taut::Index a, taut::Index b) {
        const auto p = vertex_of[std::size_t(a)];
        const auto q = vertex_of[std::size_t(b)];
        if (!good || x.col(p) != x.col(q)) return;
        good = refuse("A spring between " + vertex(obj, p) + " and " + vertex(obj, q) +
                      " has no length, by which its stiffness would be divided.");
    });
    return good;
}

/// Sentences about vertices that lie at one place.
void tell_coincident(const example::ObjText& obj, const Cloth& cloth,
                     const std::vector<taut::Index>& particle_of_vertex) {
    std::vector<taut::Index> vertex_of(static_cast<std::size_t>(cloth.size()));
    for (std::size_t v = 0; v < particle_of_vertex.size(); ++v) {
        if (particle_of_vertex[v] >= 0)
            vertex_of[static_cast<std::size_t>(particle_of_vertex[v])] = taut::Index(v);
    }
    const auto x = cloth.initial_state().x;
    taut::Index joined = 0;
    std::array<taut::Index, 2> first{};
    cloth.for_each_spring([&](taut::Index a, taut::Index b) {
        if (x.col(a) != x.col(b)) return;
        if (joined++ == 0) first = {vertex_of[std::size_t(a)], vertex_of[std::size_t(b)]};
    });
    if (joined > 0) {
        tell(std::to_string(joined) + (joined == 1 ? " spring has" : " springs have") +
             " no length: the first joins " + vertex(obj, first[0]) + " and " +
             vertex(obj, first[1]) + ", which lie at one place.");
    }
    std::vector<taut::Index> order(std::size_t(cloth.size()));
    std::iota(order.begin(), order.end(), taut::Index(0));
    const auto before = [&](taut::Index a, taut::Index b) {
        const auto* p = x.data() + 3 * a;
        const auto* q = x.data() + 3 * b;
        return std::lexicographical_compare(p, p + 3, q, q + 3);
    };
    std::sort(order.begin(), order.end(), before);
    taut::Index twins = 0;
    for (std::size_t i = 1; i < order.size(); ++i) twins += x.col(order[i - 1]) == x.col(order[i]);
    if (twins > joined) {
        tell(vertices(twins - joined) +
             " lie where another one lies without being joined to it. The mesh comes apart there "
             "unless it is welded.");
    }
}

/// @param beside  points that are to be seen, too, m
void measure(const taut::Points<double, 3>& beside) {
    const auto x = current.cloth.initial_state().x;
    Eigen::Vector3d low = x.rowwise().minCoeff();
    Eigen::Vector3d high = x.rowwise().maxCoeff();
    if (beside.cols() > 0) {
        low = low.cwiseMin(beside.rowwise().minCoeff());
        high = high.cwiseMax(beside.rowwise().maxCoeff());
    }
    shape = {};
    std::copy_n(low.data(), 3, shape.low);
    std::copy_n(high.data(), 3, shape.high);
    triangles.clear();
    std::vector<std::array<int, 2>> edges;
    const auto number = [](taut::Index i) { return static_cast<int>(i); };
    for (const auto& face : current.faces) {
        for (std::size_t i = 0; i < face.size(); ++i) {
            const int a = number(face[i]);
            const int b = number(face[(i + 1) % face.size()]);
            edges.push_back({std::min(a, b), std::max(a, b)});
        }
        for (std::size_t i = 1; i + 1 < face.size(); ++i) {
            for (const auto corner : {face[0], face[i], face[i + 1]})
                triangles.push_back(number(corner));
            const Eigen::Vector3d p = x.col(face[i]) - x.col(face[0]);
            shape.area += p.cross(x.col(face[i + 1]) - x.col(face[0])).norm() / 2;
        }
    }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    threads.clear();
    for (const auto& [a, b] : edges) {
        threads.insert(threads.end(), {a, b});
        shape.length += (x.col(a) - x.col(b)).norm();
    }
    shape.edge = current.edge = shape.length / static_cast<double>(edges.size());
}

/// Takes what was built with 1 N/m and 1 kg.
/// @param figure  points of the one that wears it, m
void take(Cloth cloth, std::vector<std::vector<taut::Index>> faces,
          const taut::Points<double, 3>& figure = taut::Points<double, 3>(3, 0)) {
    current.cloth = std::move(cloth);
    current.faces = std::move(faces);
    current.stiffness.clear();
    current.mass.clear();
    current.cloth.visit_springs(
        [](const auto& spring) { current.stiffness.push_back(spring.parameters.stiffness); });
    for (taut::Index i = 0; i < current.cloth.size(); ++i)
        current.mass.push_back(current.cloth.mass(i));
    current.worn = figure.cols() > 0;
    measure(figure);
    forget_limits();
    weigh();
    lab_reset();
}

/// Particles that no chain of springs joins to a pinned one.
taut::Index count_loose() {
    std::vector<taut::Index> parent(std::size_t(current.cloth.size()));
    std::iota(parent.begin(), parent.end(), taut::Index(0));
    const auto root = [&](taut::Index i) {
        for (; parent[std::size_t(i)] != i; i = parent[std::size_t(i)])
            parent[std::size_t(i)] = parent[std::size_t(parent[std::size_t(i)])];
        return i;
    };
    current.cloth.for_each_spring(
        [&](taut::Index a, taut::Index b) { parent[std::size_t(root(a))] = root(b); });
    std::vector<bool> held(parent.size());
    for (taut::Index i = 0; i < current.cloth.size(); ++i) {
        if (current.cloth.is_pinned(i)) held[std::size_t(root(i))] = true;
    }
    taut::Index loose = 0;
    for (taut::Index i = 0; i < current.cloth.size(); ++i) loose += !held[std::size_t(root(i))];
    return loose;
}

}  // namespace

Scene& scene() { return current; }

void weigh() {
    const bool held = current.cloth.pinned_count() > 0;
    current.cloth.set_gravity({0, 0, held ? -gravity : 0});
}

}  // namespace lab

using lab::current;

char* lab_text(int bytes) {
    lab::file.text.resize(static_cast<std::size_t>(bytes));
    return lab::file.text.data();
}

int lab_read() {
    lab::words.clear();
    lab::file.obj = example::parse_obj(std::move(lab::file.text));
    const example::ObjText& obj = *lab::file.obj;
    if (!obj.why.empty()) {
        return lab::refuse(obj.line > 0 ? "Line " + std::to_string(obj.line) + ": " + obj.why + "."
                                        : "The file " + obj.why + ".");
    }
    const taut::Index count = obj.mesh.vertices.cols();
    if (count > lab::most_vertices) {
        return lab::refuse("The file has " + std::to_string(count) +
                           " vertices; the lab takes up to " + std::to_string(lab::most_vertices) +
                           ".");
    }
    return true;
}

int lab_open_mesh(double scale, int up, int options) {
    lab::words.clear();
    if (!lab::file.obj || !lab::file.obj->why.empty()) return lab::refuse("There is no mesh.");
    if (!(scale > 0) || !std::isfinite(scale))
        return lab::refuse("The scale is a number above 0, in metres.");
    const example::ObjText& obj = *lab::file.obj;
    const auto x = lab::upright(obj.mesh.vertices, scale, up);
    if (!lab::check_place(obj, x)) return false;
    auto faces = obj.mesh.faces;
    if (options & 1) {
        auto welded = taut::weld_vertices<double>(x, faces);
        faces = std::move(welded.faces);
        if (faces.empty()) return lab::refuse("Welded, no two corners of a face stay apart.");
        lab::tell(lab::vertices(welded.welded) +
                  " lay where another one lies and became one with it.");
    }
    taut::MeshOptions spring_options{1, lab::bend_share, 1};
    spring_options.mass_by_area = (options & 2) != 0;
    spring_options.stiffness_by_length = (options & 4) != 0;
    if (spring_options.mass_by_area && !lab::check_area(obj, x, faces)) return false;
    if (spring_options.stiffness_by_length && !lab::check_length(obj, x, faces)) return false;
    auto mesh = taut::springs_from_mesh<double>(x, faces, spring_options);
    for (auto& face : faces) {
        for (auto& corner : face) corner = mesh.particle_of_vertex[std::size_t(corner)];
    }
    const auto left_out = mesh.unused_vertices;
    if (left_out > 0 && !(options & 1)) {
        lab::tell(lab::vertices(left_out) + " that no face or line uses " +
                  (left_out == 1 ? "is" : "are") + " left out.");
    }
    if (!obj.mesh.skipped.empty()) lab::tell("The reader " + obj.mesh.skipped + ".");
    lab::tell_coincident(obj, mesh.system, mesh.particle_of_vertex);
    lab::take(std::move(mesh.system), std::move(faces));
    lab_pin_top();
    return true;
}

void lab_open_cloth(int side) {
    lab::words.clear();
    taut::ClothOptions options;
    options.rows = options.columns = side;
    options.stretch = 1;
    options.bend = lab::bend_share;
    options.mass = 1;
    std::vector<std::vector<taut::Index>> faces;
    for (taut::Index r = 0; r + 1 < side; ++r) {
        for (taut::Index c = 0; c + 1 < side; ++c) {
            const taut::Index i = r * side + c;
            faces.push_back({i, i + 1, i + side + 1, i + side});
        }
    }
    lab::take(taut::hanging_cloth<double>(options), std::move(faces));
}

void lab_open_figure() {
    lab::words.clear();
    lab::Cloth cloth;
    std::vector<std::vector<taut::Index>> faces;
    const example::Figure figure;
    const auto x = example::lay_out(lab::garments, figure);
    const example::Fabric fabric{1 / double(x.cols()), 1, lab::garment_bend};
    example::add_garments<taut::Hookean>(cloth, faces, lab::garments, x, fabric);
    taut::Points<float, 3> skin(3, example::figure_points);
    example::draw(figure, skin, 0);
    lab::take(std::move(cloth), std::move(faces), skin.cast<double>());
}

const char* lab_words() { return lab::words.c_str(); }
int lab_size() { return static_cast<int>(current.cloth.size()); }
int lab_springs() { return static_cast<int>(current.cloth.spring_count()); }

const LabShape* lab_shape() {
    lab::shape.pinned = static_cast<double>(current.cloth.pinned_count());
    lab::shape.loose = static_cast<double>(lab::count_loose());
    return &lab::shape;
}
const int* lab_triangles() { return lab::triangles.data(); }
int lab_triangle_count() { return static_cast<int>(lab::triangles.size() / 3); }
const int* lab_threads() { return lab::threads.data(); }
int lab_thread_count() { return static_cast<int>(lab::threads.size() / 2); }

void lab_pin(int particle, int pinned) {
    pinned ? current.cloth.pin(particle) : current.cloth.unpin(particle);
    lab::weigh();
}

void lab_unpin_all() {
    for (taut::Index i = 0; i < current.cloth.size(); ++i) current.cloth.unpin(i);
    lab::weigh();
}

void lab_pin_top() {
    const auto x = current.cloth.initial_state().x;
    const Eigen::Vector3d size = x.rowwise().maxCoeff() - x.rowwise().minCoeff();
    const bool flat = size[2] < 0.01 * size.norm();
    const Eigen::RowVectorXd height = flat ? Eigen::RowVectorXd(-x.row(1)) : x.row(2);
    const double lowest = height.maxCoeff() - 0.01 * (height.maxCoeff() - height.minCoeff());
    for (taut::Index i = 0; i < current.cloth.size(); ++i)
        height[i] >= lowest ? current.cloth.pin(i) : current.cloth.unpin(i);
    lab::weigh();
}

const unsigned char* lab_pinned() {
    lab::pinned.resize(std::size_t(current.cloth.size()));
    for (taut::Index i = 0; i < current.cloth.size(); ++i)
        lab::pinned[std::size_t(i)] = current.cloth.is_pinned(i);
    return lab::pinned.data();
}

void lab_knobs(double stiffness, double mass, double alpha, double drag) {
    current.knob = stiffness;
    for (std::size_t s = 0; s < current.stiffness.size(); ++s)
        current.cloth.set_stiffness(taut::Index(s), stiffness * current.stiffness[s]);
    for (std::size_t i = 0; i < current.mass.size(); ++i)
        current.cloth.set_mass(taut::Index(i), mass * current.mass[i]);
    current.cloth.set_rayleigh({drag, alpha});
}
