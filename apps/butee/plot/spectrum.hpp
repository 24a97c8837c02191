#pragma once

#include <vector>

namespace butee::app::plot {

/// The amplitude spectrum of a signal.
struct Spectrum {
  std::vector<double> frequencies;  ///< Hz, from the first above 0 up to half the sampling rate
  std::vector<double> amplitudes;   ///< in the signal's unit: a cosine of amplitude A has A at its frequency
};

/// Spectrum of a signal at ascending times (s): discrete Fourier transform of its deviation from the mean
/// under a Hann window, 2 |X_k| / sum(w). Unevenly spaced samples are first replaced by as many evenly spaced
/// ones by linear interpolation. A frequency between two spectral lines appears up to 15 % too small. Empty
/// for fewer than 8 samples.
Spectrum amplitude_spectrum(const std::vector<double>& times, const std::vector<double>& values);

/// As above for y + i z: frequencies ascend from minus half the sampling rate; y = A cos, z = A sin has the
/// amplitude A at the positive frequency alone.
Spectrum full_spectrum(const std::vector<double>& times, const std::vector<double>& y, const std::vector<double>& z);

}  // namespace butee::app::plot
