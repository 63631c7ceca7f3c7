"""The Qt application: windows, pages, widgets, theme. Holds no decision about motion."""
