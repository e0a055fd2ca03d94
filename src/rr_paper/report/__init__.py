"""The reproduction and the calibration as documents, records and figures."""
