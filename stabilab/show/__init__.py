"""Everything that is drawn or typeset; the only place that imports matplotlib, pyvista, jinja2."""
