# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# Which files of a room one compiler takes: what they instantiate alike is compiled once. No group takes more than
# 1.2 GB; the files that no group names are one more.
set(groups_bdf2 "bdf2_scenes bdf2_limit_test")
set(groups_constraints held_solvers_test)
set(groups_contact contacts_test fast_contacts_test flush_contacts_test guarded_contacts_test layers_test
    particle_scene_double particle_scene_float particle_solve_test pressed_contacts_test self_contact_test skin_test)
set(groups_extremes "steppers step_test")
set(groups_guard guard_trials guarded_types_test)
set(groups_imex "imex_scenes_laws imex_scenes_laws_3d")
set(groups_integrator
    "implicit_euler_test state_view_implicit_test"
    long_double_test
    "stepper_scenes steppers_test energy_stable_euler_test"
    "edited_system_test buckling_strip_test state_view_test")
set(groups_modal modal_dynamics_test)
set(groups_network "force_test parts_test spring_set_test spring_system_test")
set(groups_newton convex_scene convex_scene_2d convex_scene_3d newton_scenes_2d)
set(groups_own_matrices "matrix_pencil_test steps_test")
set(groups_projective "projective_by_eigen projective_by_eigen_float")
set(groups_proof
    "growth_test lanczos_test large_test limit_test"
    "pencil_test small_eigenvalue_test rayleigh_test step_limit_test")
set(groups_resolution resolution_scenes)
set(groups_solids solids_energy_test)
set(groups_solver "conjugate_gradient_test two_level_test")
set(groups_step "sweep_forces_test" "energy_stable_sweep_test sweep_test")
set(groups_support
    "scene_any_double_1 scene_any_double_2 scene_any_double_3 scene_any_float_3"
    "analysis compiled_once"
    held_once
    "scene_double scene_laws_double scene_float scene_laws_float"
    decompositions)

function(taut_compile_together target room sources)
    set(number 0)
    foreach(group IN LISTS groups_${room})
        math(EXPR number "${number} + 1")
        separate_arguments(group)
        foreach(name IN LISTS group)
            if(NOT EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/${room}/${name}.cpp)
                message(FATAL_ERROR "together.cmake: there is no ${room}/${name}.cpp")
            endif()
            set_source_files_properties(${room}/${name}.cpp PROPERTIES UNITY_GROUP ${number})
            list(REMOVE_ITEM sources ${room}/${name}.cpp)
        endforeach()
    endforeach()
    set_source_files_properties(${sources} PROPERTIES UNITY_GROUP 0)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()
