    // The bus: a Wishbone master. What it sets at a falling edge of the clock stands still at the rising one.
    localparam integer ACCESS_CYCLES_MAX = {{ access_cycles_max }};
    reg wb_cyc, wb_we;
    reg [10:0] wb_adr;
    reg [31:0] wb_dat_to_card;
    wire [31:0] wb_dat_from_card;
    wire wb_ack, wb_err;

    task host_idle;
        begin
            wb_cyc = 1'b0;
            wb_we = 1'b0;
            wb_adr = 11'd0;
            wb_dat_to_card = 32'd0;
        end
    endtask

    task transfer(input write, input [31:0] address, input [31:0] value);
        integer k;
        begin
            @(negedge clk);
            wb_cyc = 1'b1;
            wb_we = write;
            wb_adr = address[10:0];
            wb_dat_to_card = value;
            for (k = 0; k < ACCESS_CYCLES_MAX && !wb_ack && !wb_err; k = k + 1)
                @(negedge clk);
            check("wb_ack_o", {47'd0, wb_ack}, 48'd1);
            check("wb_err_o", {47'd0, wb_err}, 48'd0);
            answer = wb_dat_from_card;
            @(negedge clk);
            host_idle;
        end
    endtask
