"""All poses of a range: predicted from the branch or interpolated, corrected, and differentiated implicitly."""
