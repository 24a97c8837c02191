#pragma once

#include <array>

namespace butee::integrators::rodas4_coefficients {

/// Coefficients of RODAS4(3), six stages, stiffly accurate, in the form
///
///     (1/(h gamma) - J) u_i = f(t + c_i h, y + sum_j a_ij u_j) + (1/h) sum_j c_ij u_j + h gamma_i f_t
///     y_1 = y + sum_j a_5j u_j + u_5,    error estimate u_5.
///
/// The published numbers (E. Hairer and G. Wanner, Solving Ordinary Differential Equations II,
/// section IV.7) satisfy the order conditions to 1e-9 only, which is an error of 1e-9 per radian
/// for any step size. The values here are the nearest ones that satisfy them to rounding;
/// tests/unit/rodas4_coefficients_test.cpp evaluates all conditions.
inline constexpr double kGamma = 0.25;
inline constexpr std::array<double, 6> kTimes = {0.0, 0.386, 0.21, 0.63, 1.0, 1.0};
inline constexpr std::array<double, 6> kRates = {0.25, -0.1043, 0.1035, -0.0362, 0.0, 0.0};
inline constexpr double kA[6][5] = {
    {},
    {1.544},
    {0.9466785281152614771, 0.2557011699790543556},
    {3.314825186630249493, 2.896124016147573369, 0.9986419152331355462},
    {1.221224508671903919, 6.019134481706941155, 12.53708333116215966, -0.6878860358777474634},
    {1.221224508671903919, 6.019134481706941155, 12.53708333116215966, -0.6878860358777474634, 1.0}};
inline constexpr double kC[6][5] = {
    {},
    {-5.6688},
    {-2.430093356827429448, -0.2063599156937426855},
    {-0.1073529046743619047, -9.594562251413204173, -20.47028615124450936},
    {7.496443313947807777, -10.24680431470373384, -33.99990352828958488, 11.70890893183920854},
    {8.083246796335244742, -7.981132988143881751, -31.52159432979249904, 16.31930543131752491, -6.058818238971781155}};

/// Dense output of order 3 at y(t + s h) = (1 - s) y + s (y_1 + (1 - s) (d + s e)), d = sum_j kFirst_j u_j and e the
/// same with kSecond; as published in the program RODAS.
inline constexpr std::array<double, 5> kFirst = {10.12623508344586, -7.487995877610167, -34.80091861555747,
                                                 -7.992771707568823, 1.025137723295662};
inline constexpr std::array<double, 5> kSecond = {-0.6762803392806898, 6.087714651680015, 16.43084320892478,
                                                  24.76722511418386, -6.594389125716872};

}  // namespace butee::integrators::rodas4_coefficients
