"""Measures Tapemark and other marker systems on rendered scenes."""
