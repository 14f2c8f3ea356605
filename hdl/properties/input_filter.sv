// short_pulses_ignored unless HAS_DOUBLE (samples at both edges): The level follows DATA only after more samples in a row than the filter ignores.
reg [4:0] f_other; initial f_other = 5'd0;
wire f_differs = sample != filtered;
always @(posedge clock) begin
    f_other <= 5'd0;
    if (f_differs & !reset) f_other <= (f_other == 5'd31) ? f_other : f_other + 5'd1;
end
always @* begin
    short_pulses_ignored: assert (HAS_DOUBLE | (settled == filtered) | (f_differs & (f_other >= {1'b0, filter_cycles})));
    short_pulses_ignored_count: assert (HAS_DOUBLE | (different <= f_other));
end
