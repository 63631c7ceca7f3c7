"""Serial bytes to decoded, calibrated, time-stamped samples."""
